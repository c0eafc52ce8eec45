import { type Client, type ErrorHistory, type LogLine, type State, isLockedOut } from './protocol';
import { Signal } from './signal';
import { storeHere, storedHere } from './stored';

export type Connected = 'connecting' | 'connected' | 'lost' | 'locked';

const retryMs = 1000;

/// Keeps the page in touch with the server: enters with the token, listens to events, and comes
/// back when the server was started again.
export class Connection {
  readonly status = new Signal<Connected>('connecting');
  readonly state = new Signal<State | null>(null);
  readonly log = new Signal<LogLine | null>(null);
  readonly history = new Signal<ErrorHistory>({ elapsed_s: [], error: [] });
  private events: EventSource | null = null;
  private isTrying = false;

  constructor(private readonly client: Client) {
    window.addEventListener('hashchange', () => this.takeToken() && void this.open());
  }

  /// Enters, or waits until it can.
  async open(): Promise<void> {
    if (this.isTrying) return;
    this.isTrying = true;
    this.events?.close();
    this.events = null;
    const isNew = this.takeToken();
    for (let isFirst = true; ; isFirst = false) {
      try {
        if (isFirst && isNew) await this.login();
        await this.enter();
        break;
      } catch (error) {
        if (isLockedOut(error)) {
          this.status.value = 'locked';
          break;
        }
        this.status.value = 'lost';
        await new Promise((done) => setTimeout(done, retryMs));
      }
    }
    this.isTrying = false;
  }

  /// Something could not be asked: looks after the server.
  suspect(error: unknown): void {
    if (this.isTrying || this.status.value === 'locked') return;
    if (isLockedOut(error) || error instanceof TypeError) {
      this.status.value = 'lost';
      void this.open();
    }
  }

  /// A link or a token that somebody typed.
  async unlock(text: string): Promise<boolean> {
    const token = /token=([^&\s]+)/.exec(text)?.[1] ?? text.trim();
    if (!token) return false;
    storeHere('token', decodeURIComponent(token));
    try {
      await this.login();
    } catch {
      return false;
    }
    void this.open();
    return true;
  }

  private async enter(): Promise<void> {
    let state: State;
    try {
      state = await this.client.state();
    } catch (error) {
      // A server that was started again knows no cookie yet, but perhaps the same token.
      if (!isLockedOut(error) || !storedHere('token')) throw error;
      await this.login();
      state = await this.client.state();
    }
    this.listen();
    this.status.value = 'connected';
    this.state.value = state;
  }

  private async login(): Promise<void> {
    await this.client.login(storedHere('token') ?? '');
  }

  /// The token is kept for this tab and leaves the address, so that no picture of the screen and no
  /// history shows it.
  private takeToken(): boolean {
    const token = /[#&]token=([^&]+)/.exec(location.hash)?.[1];
    if (!token) return false;
    storeHere('token', decodeURIComponent(token));
    history.replaceState(null, '', location.pathname + location.search);
    return true;
  }

  private listen(): void {
    const events = this.client.events();
    this.events = events;
    const on = <T>(name: string, take: (value: T) => void) =>
      events.addEventListener(name, (event) => take(JSON.parse((event as MessageEvent<string>).data) as T));
    on<State>('state', (value) => (this.state.value = value));
    on<LogLine>('log', (value) => (this.log.value = value));
    on<ErrorHistory>('error_history', (value) => (this.history.value = value));
    events.onerror = () => {
      if (this.events !== events) return;
      this.status.value = 'lost';
      void this.open();
    };
  }
}
