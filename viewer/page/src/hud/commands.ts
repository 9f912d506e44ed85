// SPDX-License-Identifier: GPL-3.0-or-later
// What the page asks of the engine, as command and argument (see user_command_t), and how to find who offers a command.
import type { Bundle, CommandData, CommandGroup, ToolData } from '../bundle';

export interface UserCommand {
  command: string;
  argument: string;
}

/** The engine refuses more. */
export const longest_argument_bytes = 400;

const words = (...w: string[]): string => w.map((x) => x.trim()).filter((x) => x !== '').join(' ');

export const exchange = (hand: 'left' | 'right', tool: string): UserCommand => ({ command: 'exchange', argument: words(hand, tool) });

export const ask = (id: string, command: string, argument = ''): UserCommand => ({ command: 'ask', argument: words(id, command, argument) });

/** One line, cut at a whole character so that the engine takes it; null when nothing is left. */
export function message(text: string): UserCommand | null {
  let line = text.replace(/\s+/g, ' ').trim();
  const size = (s: string) => new TextEncoder().encode(s).length;
  while (size(line) > longest_argument_bytes) line = [...line].slice(0, -1).join('');
  return line === '' ? null : { command: 'message', argument: line };
}

/** A command takes a number when its range is not empty. */
export const takes_number = (c: CommandData): boolean => c.max > c.min;

/** Number as the engine reads it: inside the range, no exponent, no trailing zeros. */
export function number_argument(value: number, c: CommandData): string {
  const v = Math.max(c.min, Math.min(c.max, Number.isFinite(value) ? value : c.min));
  return String(Number(v.toFixed(6)));
}

/** First component that offers a command of this name. */
export function find_command(groups: readonly CommandGroup[], name: string): { id: string; command: CommandData } | null {
  for (const g of groups) {
    const command = g.commands.find((c) => c.name === name);
    if (command) return { id: g.id, command };
  }
  return null;
}

/** Instruments that hold clips: those that offer `load`. */
export function appliers(bundle: Bundle): ToolData[] {
  const ids = bundle.commands.filter((g) => g.commands.some((c) => c.name === 'load')).map((g) => g.id);
  return bundle.tools.filter((t) => ids.includes(t.id));
}
