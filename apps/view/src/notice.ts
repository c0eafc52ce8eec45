import type { Connection } from './connection';
import type { State } from './protocol';
import { byId, setText } from './dom';

/// What stands over the picture when there is no connection, no picture, or an error.
export function startNotice(connection: Connection): void {
  const form = byId<HTMLFormElement>('unlock');
  const field = byId<HTMLInputElement>('token');
  form.addEventListener('submit', async (event) => {
    event.preventDefault();
    const isOpen = await connection.unlock(field.value);
    setText(byId('unlock-message'), isOpen ? '' : 'The server does not take this token. Copy the whole link from its terminal.');
    if (isOpen) field.value = '';
  });
  const show = () => {
    const { title, text, tone } = noticeOf(connection);
    const box = byId('notice');
    box.hidden = title === '';
    box.dataset.tone = tone;
    setText(byId('notice-title'), title);
    setText(byId('notice-text'), text);
    const isLocked = connection.status.value === 'locked';
    form.hidden = !isLocked;
    document.documentElement.dataset.connection = connection.status.value;
  };
  connection.status.watch(show);
  connection.state.onChange(show);
}

interface Notice {
  title: string;
  text: string;
  tone: 'quiet' | 'bad';
}

const nothing: Notice = { title: '', text: '', tone: 'quiet' };

function noticeOf({ status, state }: Connection): Notice {
  if (status.value === 'locked')
    return {
      title: 'A new link is needed',
      text: 'The server was started anew, or this page was opened without its token. Open the link that kaustik view printed, or paste it here.',
      tone: 'quiet',
    };
  if (status.value === 'lost')
    return { title: 'No connection', text: 'The server does not answer. This page goes on by itself once it does.', tone: 'quiet' };
  if (status.value === 'connecting') return { title: 'Connecting', text: '', tone: 'quiet' };
  return state.value ? noticeOfState(state.value) : nothing;
}

function noticeOfState({ state, failure, refusal, passes }: State): Notice {
  if (state === 'failed') return { title: 'The render failed', text: failure ?? '', tone: 'bad' };
  if (refusal) return { title: 'An edit was refused; the picture before goes on', text: refusal.text, tone: 'bad' };
  if (state === 'building' && passes === 0) return { title: 'Building the scene', text: '', tone: 'quiet' };
  return nothing;
}
