// The camera's image with what was seen in it: outlines, names, superquadrics; what the question is
// about stands out by a double line, a sign before its name and weight, not by colour alone. Where it
// says "the outlined objects", only those are outlined.

import { byId, draw, make, setText } from './dom.js';
import { category, t } from './i18n.js';
import { wireframe } from './superquadric.js';

const MIN_FRAME_MS = 250;  // between two images

/** Ids of the objects a query speaks of, each with the numbers of the options that name it. */
export function objectsOf(query) {
  const named = new Map();
  if (!query) return named;
  if (query.kind === 'choice') {
    query.options.forEach((option, i) => {
      for (const id of option.objects ?? []) named.set(id, [...(named.get(id) ?? []), i + 1]);
    });
  } else {
    for (const object of query.yes_if?.objects ?? []) named.set(object.object_id, []);
    for (const option of query.options) {
      for (const id of option.objects ?? []) if (!named.has(id)) named.set(id, []);
    }
  }
  return named;
}

/** id -> instance, as far as the query knows. */
function instances(query) {
  const known = new Map();
  for (const each of [...(query?.yes_if?.objects ?? []), ...(query?.likeliest ?? [])]) {
    known.set(each.object_id, each.instance);
  }
  return known;
}

export class Picture {
  constructor() {
    this.show = { picture: true, shapes: true };
    this.frameShown = null;
    this.frameAt = 0;
    this.wanted = null;
    this.image = make('img', { alt: '' });
    this.svg = draw('svg', { role: 'img', preserveAspectRatio: 'xMidYMid meet' });
    this.caption = make('figcaption');
    this.figure = byId('picture');
    this.figure.append(make('div', { class: 'frame' }, this.image, this.svg), this.caption);
    this.image.addEventListener('load', () => this.figure.classList.add('has-image'));
    this.image.addEventListener('error', () => this.figure.classList.remove('has-image'));
    new ResizeObserver(() => this.scaleLabels()).observe(this.svg);
  }

  update(state) {
    const { scene, frame_seq: frame } = state;
    const isShown = this.show.picture && Boolean(scene);
    this.figure.hidden = !isShown;
    if (!isShown) return;
    this.wantFrame(frame);
    const lit = litObjects(state);
    const key = JSON.stringify([scene, state.query?.id, [...lit], this.show, document.documentElement.lang]);
    if (key === this.key) return;
    this.key = key;
    this.drawScene(scene, state.query, lit);
  }

  wantFrame(seq) {
    if (seq === null || seq === undefined || seq === this.frameShown) return;
    const wait = this.frameAt + MIN_FRAME_MS - performance.now();
    this.wanted = seq;
    if (this.timer) return;
    this.timer = setTimeout(() => {
      this.timer = null;
      this.frameAt = performance.now();
      this.frameShown = this.wanted;
      this.image.src = `/api/frame?seq=${this.wanted}`;
    }, Math.max(0, wait));
  }

  drawScene(scene, query, lit) {
    this.svg.setAttribute('viewBox', `0 0 ${scene.width} ${scene.height}`);
    this.image.width = scene.width;
    this.image.height = scene.height;
    const asked = objectsOf(query);
    const known = instances(query);
    const shapes = draw('g', { class: 'shapes' });
    if (this.show.shapes) {
      for (const each of scene.superquadrics ?? []) {
        if (each.converged) shapes.append(drawShape(each, scene.intrinsics));
      }
    }
    const outlines = draw('g');
    const labels = draw('g');
    for (const object of scene.objects) {
      const look = { isAsked: asked.has(object.id), isLit: lit.has(object.id) };
      const name = objectName(object, scene, known);
      if (look.isAsked || query?.kind !== 'set') outlines.append(...drawOutline(object, look));
      labels.append(drawLabel(object, name, asked.get(object.id), look));
    }
    this.svg.replaceChildren(shapes, outlines, labels);
    this.say(scene, asked, known);
    this.scaleLabels();
  }

  say(scene, asked, known) {
    const names = (objects) => objects.map((object) => objectName(object, scene, known)).join(', ');
    const about = scene.objects.filter((object) => asked.has(object.id));
    const all = scene.objects.length === 0 ? t(scene.has_table ? 'picture.empty' : 'picture.no_table')
      : t('picture.objects', { names: names(scene.objects) });
    const question = about.length > 0 ? ` ${t('picture.about', { names: names(about) })}` : '';
    this.svg.setAttribute('aria-label', all + question);
    setText(this.caption, all + question);
  }

  /** Labels keep the page's size of text however the image is scaled, and stay inside of it. */
  scaleLabels() {
    const width = this.svg.clientWidth;
    const rem = parseFloat(getComputedStyle(document.documentElement).fontSize);
    if (width > 0) {
      const unit = (this.svg.viewBox.baseVal?.width || width) / width;
      this.svg.style.setProperty('--unit', `${unit}px`);
      this.svg.style.setProperty('--label', `${Math.min(rem, 24) * unit}px`);
      for (const label of this.svg.querySelectorAll('text')) {
        const half = label.getComputedTextLength() / 2 + 4;
        const x = Number(label.dataset.x);
        label.setAttribute('x', Math.max(half, Math.min(width * unit - half, x)));
      }
    }
  }
}

/** Objects of what a switch would choose now. */
function litObjects({ query, highlight }) {
  const lit = new Set();
  if (query?.kind !== 'choice') return lit;
  for (const i of highlight?.options ?? []) {
    for (const id of query.options[i]?.objects ?? []) lit.add(id);
  }
  return lit;
}

function objectName(object, scene, known) {
  if (object.ask_user && object.category !== 'Unknown') {
    return t('object.unsure', { category: category(object.category) });
  }
  const alike = scene.objects.filter((each) => each.category === object.category).length;
  const instance = alike > 1 && known.has(object.id) ? ` ${known.get(object.id)}` : '';
  return category(object.category) + instance;
}

function drawShape(shape, intrinsics) {
  const path = wireframe(shape, intrinsics)
    .map((line) => `M${line.map(([u, v]) => `${u.toFixed(1)} ${v.toFixed(1)}`).join('L')}`).join('');
  return draw('path', { d: path, class: 'shape' });
}

function drawOutline(object, { isAsked, isLit }) {
  const points = object.outline_px.map((point) => point.join()).join(' ');
  const look = `${isAsked ? ' asked' : ''}${isLit ? ' pointed' : ''}`;
  return [draw('polygon', { points, class: `under${look}` }), draw('polygon', { points, class: `over${look}` })];
}

function drawLabel(object, name, numbers, { isAsked, isLit }) {
  const u = object.outline_px.map((point) => point[0]);
  const v = object.outline_px.map((point) => point[1]);
  const x = (Math.min(...u) + Math.max(...u)) / 2;
  const sign = isAsked ? (numbers?.length ? `▶ ${numbers.join(', ')}: ` : '▶ ') : '';
  const y = Math.max(18, Math.min(...v) - 5);
  return draw('text', { x, y, 'data-x': x, class: isAsked || isLit ? 'asked' : '' }, sign + name);
}
