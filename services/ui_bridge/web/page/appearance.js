// How the page looks: theme, size of text, language, motion. Settings of the user, over which those
// of the address go: ?theme=dark&text=150&lang=de, for a second screen.

import { useLanguage } from './i18n.js';

const address = new URLSearchParams(location.search);
const dark = matchMedia('(prefers-color-scheme: dark)');
const contrast = matchMedia('(prefers-contrast: more)');
let theme = 'auto';

function applyTheme() {
  const system = contrast.matches ? 'contrast' : dark.matches ? 'dark' : 'light';
  document.documentElement.dataset.theme = theme === 'auto' ? system : theme;
}
dark.addEventListener('change', applyTheme);
contrast.addEventListener('change', applyTheme);
applyTheme();

export async function applyAppearance(settings) {
  const root = document.documentElement;
  theme = address.get('theme') ?? settings.theme ?? 'auto';
  applyTheme();
  root.dataset.motion = settings.motion ?? 'auto';
  const percent = Number(address.get('text') ?? settings.text_percent) || 100;
  root.style.setProperty('font-size', `${Math.min(250, Math.max(100, percent))}%`);
  await useLanguage(address.get('lang') ?? settings.language ?? 'auto');
}
