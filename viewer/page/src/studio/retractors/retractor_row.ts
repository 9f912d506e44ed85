// SPDX-License-Identifier: GPL-3.0-or-later
// One retractor as fields: its lobe, its place, how deep it reaches, how it leans and how far it draws.
import type { Vector3 } from 'three';
import { el } from '../../hud/dom';
import { text } from '../../languages/text';
import type { Point } from '../api';
import { field, select } from '../fields';
import { parameterField } from '../parameter_field';
import { partText } from '../part_words';
import type { Parameter } from '../scene_editor/declarations';
import { depthOf, faultOfPlace, leanOf, type Retractor, type RetractorFacts, withDepth, withLean } from './retractors';

export interface Field {
  facts: RetractorFacts;
  neck: Vector3;
  toSurgeon: Point;
}

export interface Deeds {
  choose(r: Retractor): void;
  take(): void;
  remove(): void;
}

const units = { mm: [{ symbol: 'mm', toSi: 1e-3 }], deg: [{ symbol: 'deg', toSi: Math.PI / 180 }] };

const quantity = (name: string, unit: 'mm' | 'deg', least = '', most = '', numbers = 1): Parameter => ({
  name,
  type: '',
  doc: '',
  required: true,
  fallback: '',
  min: least,
  max: most,
  choices: [],
  units: units[unit],
  numbers,
  whole: false,
  reference: '',
});

const shown = (x: number, digits: number): string => String(Number(x.toFixed(digits)));
const first = (value: string): number => Number(value.split(' ')[0]);

/** What is wrong with a place, in words; '': nothing. */
export function placeFault(r: Retractor, { facts, toSurgeon }: Field): string {
  switch (faultOfPlace(r, facts, toSurgeon)) {
    case 'outside':
      return text('The tip would lie outside of the lobes: {mm} mm from the middle of the fissure at most.', {
        mm: facts.radiusMm,
      });
    case 'lean':
      return text('No arm could hold it there: {degrees}° off the line of sight at most.', {
        degrees: facts.mostLeanDeg,
      });
    default:
      return '';
  }
}

export function retractorRow(r: Retractor, k: number, chosen: boolean, of: Field, deeds: Deeds): HTMLElement {
  const { facts, neck, toSurgeon } = of;
  const words = text('Retractor {n}', { n: k + 1 });
  const lobe = select(facts.lobes.map((name) => [name, partText(name)] as const));
  lobe.id = `retractor-${k}-lobe`;
  lobe.value = r.lobe;
  lobe.onchange = () => deeds.choose({ ...r, lobe: lobe.value });
  /** A field whose value makes another retractor of this one. */
  const made = (p: Parameter, label: string, now: string, change: (value: string) => Retractor) =>
    parameterField(p, `retractor-${k}-${p.name}`, label, {
      proposed: now,
      chosen: null,
      choose: (value) => value !== null && deeds.choose(change(value)),
      fault: (value) => placeFault(change(value), of),
    });
  const tip = r.tip_mm.map((x) => shown(x, 3)).join(' ');
  const fields = [
    made(quantity('place', 'mm', '', '', 3), text('Tip: right, forward, up'), `${tip} mm`, (value) => ({
      ...r,
      tip_mm: value.split(' ').slice(0, 3).map(Number) as Point,
    })),
    made(
      quantity('depth', 'mm'),
      text('Tip before the neck, towards the surgeon'),
      `${shown(depthOf(r, neck, toSurgeon), 2)} mm`,
      (value) => withDepth(r, neck, toSurgeon, first(value)),
    ),
    made(
      quantity('lean', 'deg', '0 deg', `${facts.mostLeanDeg} deg`),
      text('Leans off the line of sight'),
      `${shown(leanOf(r, toSurgeon), 1)} deg`,
      (value) => withLean(r, toSurgeon, first(value)),
    ),
    made(
      quantity('pull', 'mm', '0 mm', `${facts.mostPullMm} mm`),
      text('Draws the lobe aside by'),
      `${shown(r.pull_mm, 2)} mm`,
      (value) => ({ ...r, pull_mm: first(value) }),
    ),
  ];
  const take = el(
    'button',
    { type: 'button', id: `retractor-${k}-take`, 'aria-pressed': String(chosen) },
    text('Choose in the picture'),
  );
  take.onclick = () => deeds.take();
  const remove = el('button', { type: 'button', id: `retractor-${k}-remove` }, text('Remove'));
  remove.onclick = () => deeds.remove();
  return el(
    'div',
    { class: 'rule', role: 'group', 'aria-label': words },
    el('strong', {}, words),
    field(text('Lobe'), lobe),
    ...fields,
    el('div', { class: 'buttons' }, take, remove),
  );
}
