// SPDX-License-Identifier: GPL-3.0-or-later
// The certificate of a curriculum that was passed, as a page to print: certificate.html?person=NAME&curriculum=ID.
import './certificate.css';
import '../screens.css';
import { el } from '../hud/dom';
import { momentText } from '../languages/numbers';
import { languageTag, text } from '../languages/text';
import { Api } from './api';
import { certificateOf } from './certificate_api';
import type { CertifiedTask, Certificate } from './certificate_api';
import { gateText } from './gate_words';
import { resultText } from './wording';

const day = (ms: number): string => new Date(ms).toLocaleDateString(languageTag(), { dateStyle: 'long' });

function taskRow(t: CertifiedTask): HTMLElement {
  const attempts = text('{attempts, plural, one {# attempt} other {# attempts}} to the level', {
    attempts: t.attemptsToLevel,
  });
  const runs = t.runs.map((r) =>
    el('li', {}, `${momentText(new Date(r.beganMs))}: ${resultText(r)} `, el('code', {}, r.uuid)),
  );
  return el(
    'tr',
    {},
    el('td', {}, el('strong', {}, t.title), el('br'), t.module),
    el('td', {}, el('ul', {}, ...t.gates.map((g) => el('li', {}, `✓ ${gateText(g)}`)))),
    el('td', {}, day(t.passedMs), el('br'), attempts),
    el('td', { class: 'runs' }, el('ul', {}, ...runs)),
  );
}

export function certificateSheet(c: Certificate): HTMLElement {
  const head = [text('Task'), text('What was asked'), text('Passed'), text('Runs that counted')];
  return el(
    'article',
    { class: 'sheet' },
    el('p', { class: 'brand' }, 'Insula'),
    el('h1', {}, text('Record of training')),
    el('p', { class: 'who' }, text('{person} has passed the curriculum', { person: c.person })),
    el('p', { class: 'curriculum' }, c.curriculum),
    el('p', {}, text('from {from} to {to}', { from: day(c.beganMs), to: day(c.passedMs) })),
    el(
      'p',
      { class: 'warning' },
      text('For training only. This is a record of work at a simulator, and no licence to operate.'),
    ),
    el(
      'table',
      {},
      el('thead', {}, el('tr', {}, ...head.map((h) => el('th', {}, h)))),
      el('tbody', {}, ...c.tasks.map(taskRow)),
    ),
    el(
      'div',
      { class: 'lines' },
      el('p', {}, el('span', { class: 'line' }), text('Name')),
      el('p', {}, el('span', { class: 'line' }), text('Date, instructor')),
    ),
    el(
      'p',
      { class: 'issue' },
      text('Issued by the training store of this machine. Program: {version}. Curriculum: {content}.', {
        version: c.version,
        content: c.content,
      }),
      el('br'),
      el('span', { class: 'digest' }, text('Digest of the runs: {digest}', { digest: c.digest })),
    ),
  );
}

async function load(root: HTMLElement): Promise<void> {
  const query = new URLSearchParams(window.location.search);
  const api = new Api(new URL('./', window.location.href));
  const [person, curriculum] = [query.get('person') ?? '', query.get('curriculum') ?? ''];
  const print = el('button', { type: 'button' }, text('Print'));
  print.onclick = () => window.print();
  const back = el('a', { href: 'start.html' }, text('All exercises'));
  const sheet = certificateSheet(certificateOf(await api.ask('certificate', { person, curriculum })));
  root.replaceChildren(el('nav', {}, print, back), sheet);
}

const root = document.getElementById('certificate');
if (root) {
  document.title = `Insula: ${text('Record of training')}`;
  load(root).catch((e: unknown) => {
    root.replaceChildren(el('p', { role: 'alert' }, e instanceof Error ? e.message : String(e)));
  });
}
