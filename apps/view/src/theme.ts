import { Signal } from './signal';
import { store, stored } from './stored';

export type Theme = 'auto' | 'dark' | 'light';

export const theme = new Signal<Theme>(
  (['dark', 'light'] as const).find((name) => name === stored('theme')) ?? 'auto',
);

const systemIsLight = matchMedia('(prefers-color-scheme: light)');

export function startTheme(changed: () => void): void {
  const apply = () => {
    const isLight = theme.value === 'auto' ? systemIsLight.matches : theme.value === 'light';
    document.documentElement.dataset.theme = isLight ? 'light' : 'dark';
    changed();
  };
  systemIsLight.addEventListener('change', apply);
  theme.watch(apply);
  theme.onChange((value) => store('theme', value));
}

export function switchTheme(): void {
  theme.value = document.documentElement.dataset.theme === 'light' ? 'dark' : 'light';
}
