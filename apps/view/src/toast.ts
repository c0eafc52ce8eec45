import { byId, make } from './dom';

/// A short message over the picture, for some seconds.
export function toast(text: string, level: 'info' | 'error' = 'info'): void {
  const box = byId('toasts');
  const last = [...box.children].find((child) => child.textContent === text);
  last?.remove();
  const message = make('div', { class: `toast ${level}` }, text);
  box.append(message);
  while (box.children.length > 3) box.firstElementChild?.remove();
  setTimeout(() => message.remove(), level === 'error' ? 8000 : 4000);
}
