// SPDX-License-Identifier: GPL-3.0-or-later
// The generated message code, for node: the same text the page uses, with its types taken off.
import { transpileModule, ModuleKind, ScriptTarget } from 'typescript';
import { generate, read_types } from '../gen-lcm.mjs';

export async function load_lcm() {
  const { outputText } = transpileModule(generate(read_types()), { compilerOptions: { module: ModuleKind.ESNext, target: ScriptTarget.ES2022 } });
  return import(`data:text/javascript;base64,${Buffer.from(outputText).toString('base64')}`);
}
