// The page's words. A language is one file LANGUAGE.json; what it lacks is said in English.

const LANGUAGES = ['en', 'de'];  // those that have a file

let english = {};
let words = {};
let language = 'en';

export const languages = () => LANGUAGES;
export const currentLanguage = () => language;

/** "auto" is the browser's, where there is a file for it, else English. */
export function resolveLanguage(wanted) {
  const known = (name) => LANGUAGES.find((each) => each === name.toLowerCase().split('-')[0]);
  if (wanted && wanted !== 'auto') return known(wanted) ?? 'en';
  return navigator.languages.map(known).find(Boolean) ?? 'en';
}

async function load(name) {
  const response = await fetch(`${name}.json`);
  if (!response.ok) throw new Error(`${name}.json: HTTP ${response.status}`);
  return response.json();
}

/** Loads a language and says the page's fixed words in it. Where it cannot be loaded the page stays
 * as it is. */
export async function useLanguage(wanted) {
  const next = resolveLanguage(wanted);
  if (Object.keys(english).length === 0) english = await load('en');
  words = next === 'en' ? english : await load(next);
  language = next;
  document.documentElement.lang = next;
  translate(document);
}

/** The text of `key` with {name} replaced by values; `fallback`, or the key, where there is none. */
export function t(key, values = {}, fallback = key) {
  const text = words[key] ?? english[key] ?? fallback;
  return text.replace(/\{(\w+)\}/g, (_, name) => String(values[name] ?? ''));
}

/** A text that depends on a number: KEY.one or KEY.other. */
export function tn(key, n, values = {}) {
  const form = new Intl.PluralRules(language).select(n);
  const found = `${key}.${form}` in english ? `${key}.${form}` : `${key}.other`;
  return t(found, { n: number(n), ...values });
}

export const number = (value, digits = 0) =>
  new Intl.NumberFormat(language, { maximumFractionDigits: digits }).format(value);
export const percent = (value) =>
  new Intl.NumberFormat(language, { style: 'percent' }).format(value);
export const date = (utime) =>
  new Intl.DateTimeFormat(language, { dateStyle: 'medium', timeStyle: 'short' })
    .format(new Date(utime / 1000));

/** Names of the messages ("Carton", "Open") in words; the name itself where it has none. */
export const category = (name) => t(`category.${name}`, {}, name);
export const action = (name) => t(`action.${name}`, {}, name);

/** "open: carton 2" */
export function pair(task, withInstance) {
  const object = category(task.category) + (withInstance ? ` ${task.instance}` : '');
  return t('pair', { action: action(task.action), object });
}

/** Says the fixed words below `root`. */
export function translate(root) {
  for (const element of root.querySelectorAll('[data-t]')) {
    element.textContent = t(element.dataset.t);
  }
  for (const element of root.querySelectorAll('[data-t-label]')) {
    element.setAttribute('aria-label', t(element.dataset.tLabel));
  }
}
