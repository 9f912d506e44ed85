// SPDX-License-Identifier: GPL-3.0-or-later
// The generated message code, for node: the same text the page uses, with its types taken off.
import { transpileModule, ModuleKind, ScriptTarget } from 'typescript';
import { generate, readTypes } from '../gen-lcm.mjs';

export async function loadLcm() {
  const { outputText } = transpileModule(generate(readTypes()), {
    compilerOptions: { module: ModuleKind.ESNext, target: ScriptTarget.ES2022 },
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputText).toString('base64')}`);
}
