// SPDX-License-Identifier: GPL-3.0-or-later
// What the page asks of the engine, as command and argument (see user_command_t), and how to find who offers a command.
import type { Bundle, CommandData, CommandGroup, ToolData } from '../bundle_types';

export interface UserCommand {
  command: string;
  argument: string;
}

/** The engine refuses more. */
export const longestArgumentBytes = 400;

const words = (...w: string[]): string =>
  w
    .map((x) => x.trim())
    .filter((x) => x !== '')
    .join(' ');

export const exchange = (hand: 'left' | 'right', tool: string): UserCommand => ({
  command: 'exchange',
  argument: words(hand, tool),
});

export const softGuide = (on: boolean): UserCommand => ({ command: 'soft_guide', argument: on ? 'on' : 'off' });

export const ask = (id: string, command: string, argument = ''): UserCommand => ({
  command: 'ask',
  argument: words(id, command, argument),
});

/** One line, cut at a whole character so that the engine takes it; null when nothing is left. */
export function message(text: string): UserCommand | null {
  let line = text.replace(/\s+/g, ' ').trim();
  const size = (s: string) => new TextEncoder().encode(s).length;
  while (size(line) > longestArgumentBytes) line = [...line].slice(0, -1).join('');
  return line === '' ? null : { command: 'message', argument: line };
}

/** A command takes a number when its range is not empty. */
export const takesNumber = (c: CommandData): boolean => c.max > c.min;

/** Number as the engine reads it: inside the range, no exponent, no trailing zeros. */
export function numberArgument(value: number, c: CommandData): string {
  const v = Math.max(c.min, Math.min(c.max, Number.isFinite(value) ? value : c.min));
  return String(Number(v.toFixed(6)));
}

/**
 * An instrument, one of its commands, and the tools that the command takes: those of the kind that its argument
 * names.
 */
export interface ToolCommand {
  holder: ToolData;
  command: CommandData;
  tools: ToolData[];
}

/** Commands whose argument is "KIND id", of a kind that the scene has tools of. */
export function toolCommands(bundle: Bundle): ToolCommand[] {
  return bundle.tools.flatMap((holder) => {
    const commands = bundle.commands.find((g) => g.id === holder.id)?.commands ?? [];
    return commands.flatMap((command) => {
      const kind = /^(\S+) id$/.exec(command.argument)?.[1];
      const tools = bundle.tools.filter((t) => t.kind === kind && t.hand !== 'left' && t.hand !== 'right');
      return tools.length > 0 ? [{ holder, command, tools }] : [];
    });
  });
}

/** Commands of tools are the trainee's own. */
export function sceneCommands(bundle: Bundle): CommandGroup[] {
  return bundle.commands.filter((g) => g.commands.length > 0 && !bundle.tools.some((t) => t.id === g.id));
}

export interface Request {
  /** Of the component. */
  id: string;
  command: CommandData;
  usual: number;
}

/** What the surgeon may ask the anaesthetist for. */
export function surgeonRequests(bundle: Bundle): Request[] {
  return bundle.commands.flatMap(({ id, commands }) =>
    commands.flatMap((command) => (command.usual === null ? [] : [{ id, command, usual: command.usual }])),
  );
}

/** Commands without an argument of the components whose channels walls show in the infrared picture. */
export function glowCommands(bundle: Bundle): { id: string; command: CommandData }[] {
  const shown = new Set(bundle.bodies.flatMap((b) => Object.values(b.channelOfRegion)));
  const components = new Set(bundle.channels.filter((c) => shown.has(c.id)).map((c) => c.component));
  return bundle.commands
    .filter((g) => components.has(g.id))
    .flatMap((g) => g.commands.filter((c) => c.argument === '').map((command) => ({ id: g.id, command })));
}
