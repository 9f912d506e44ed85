// SPDX-License-Identifier: GPL-3.0-or-later
import { describe, expect, it } from 'vitest';
import { runOf } from '../src/start/api';
import { recorded } from '../src/start/recordings';

describe('recordings', () => {
  const run = (uuid: string, recording: string) => runOf({ uuid, recording })!;
  it('have one line each, if they are still there', () => {
    const lines = recorded([run('3', 'b'), run('2', 'a'), run('1', 'b'), run('0', 'gone')], new Set(['a', 'b']));
    expect(lines.map((l) => [l.name, l.runs.length])).toEqual([
      ['b', 2],
      ['a', 1],
    ]);
  });
});
