// SPDX-License-Identifier: GPL-3.0-or-later
// Generates src/lcm.ts (types, encoders, decoders, fingerprints) from ../../lcm_types/*.lcm.
//
// Mapping: int64_t -> bigint, other numbers -> number, boolean -> boolean, string -> string, structs -> objects,
// arrays of numbers -> one flat typed array (Float32Array, ...) even when they have several dimensions,
// arrays of structs, strings and booleans -> plain arrays (one dimension only).
import { readFileSync, readdirSync, writeFileSync, existsSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import * as runtime from './lcm-runtime.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const numeric = {
  int8_t: { size: 1, get: 'getInt8', set: 'setInt8', array: 'Int8Array' },
  byte: { size: 1, get: 'getUint8', set: 'setUint8', array: 'Uint8Array' },
  int16_t: { size: 2, get: 'getInt16', set: 'setInt16', array: 'Int16Array' },
  int32_t: { size: 4, get: 'getInt32', set: 'setInt32', array: 'Int32Array' },
  int64_t: { size: 8, get: 'getBigInt64', set: 'setBigInt64', array: 'BigInt64Array' },
  float: { size: 4, get: 'getFloat32', set: 'setFloat32', array: 'Float32Array' },
  double: { size: 8, get: 'getFloat64', set: 'setFloat64', array: 'Float64Array' },
};
const primitive = new Set([...Object.keys(numeric), 'string', 'boolean']);

/** Parses .lcm text into [{name, members: [{name, type, dims: [{size, constant}]}]}]. */
export function parse(text) {
  const tokens =
    text
      .replace(/\/\*[\s\S]*?\*\//g, ' ')
      .replace(/\/\/[^\n]*/g, ' ')
      .match(/[A-Za-z_][\w.]*|\d+|[{}[\];,=]/g) ?? [];
  const structs = [];
  let i = 0;
  const expect = (t) => {
    if (tokens[i++] !== t) throw new Error(`expected "${t}" before "${tokens.slice(i - 1, i + 4).join(' ')}"`);
  };
  while (i < tokens.length) {
    if (tokens[i] === 'package') {
      i += 2;
      expect(';');
      continue;
    }
    expect('struct');
    const struct = { name: tokens[i++], members: [] };
    expect('{');
    while (tokens[i] !== '}') {
      const type = tokens[i++].split('.').pop();
      if (type === 'const') throw new Error('constants are not supported');
      for (;;) {
        const member = { type, name: tokens[i++], dims: [] };
        while (tokens[i] === '[') {
          const size = tokens[i + 1];
          member.dims.push({ size, constant: /^\d+$/.test(size) });
          i += 2;
          expect(']');
        }
        struct.members.push(member);
        if (tokens[i] !== ',') break;
        i++;
      }
      expect(';');
    }
    expect('}');
    structs.push(struct);
  }
  return structs;
}

const mask = (1n << 64n) - 1n;

/** LCM's hash of one struct without its members' structs; see lcm's documentation of the type language. */
function baseHash(struct) {
  let v = 0x12345678n;
  const update = (c) => {
    const signed = BigInt.asIntN(64, v);
    v = BigInt.asUintN(64, ((v << 8n) ^ (signed >> 55n)) + BigInt(c));
  };
  const text = (s) => {
    update(s.length);
    for (const c of s) update(c.charCodeAt(0));
  };
  for (const m of struct.members) {
    text(m.name);
    if (primitive.has(m.type)) text(m.type);
    update(m.dims.length);
    for (const d of m.dims) {
      update(d.constant ? 0 : 1);
      text(d.size);
    }
  }
  return v;
}

/** LCM's fingerprint of a struct with everything it contains. */
export function fingerprint(name, structs, parents = []) {
  if (parents.includes(name)) return 0n;
  const struct = structs.find((s) => s.name === name);
  if (!struct) throw new Error(`unknown type ${name}`);
  let v = baseHash(struct);
  for (const m of struct.members)
    if (!primitive.has(m.type)) v = (v + fingerprint(m.type, structs, [...parents, name])) & mask;
  return ((v << 1n) & mask) + (v >> 63n);
}

const pascal = (s) =>
  s
    .replace(/_t$/, '')
    .split('_')
    .map((w) => w[0].toUpperCase() + w.slice(1))
    .join('');

/** TypeScript's type of a value without dimensions, and its empty value. */
function scalar(type) {
  if (type === 'int64_t') return { type: 'bigint', empty: '0n' };
  if (type === 'string') return { type: 'string', empty: "''" };
  if (type === 'boolean') return { type: 'boolean', empty: 'false' };
  return numeric[type] ? { type: 'number', empty: '0' } : { type: pascal(type), empty: `make_${type}()` };
}

function fieldType(m) {
  if (m.dims.length === 0) return scalar(m.type).type;
  if (numeric[m.type]) return numeric[m.type].array;
  if (m.dims.length > 1) throw new Error(`${m.name}: several dimensions of ${m.type} are not supported`);
  return `${scalar(m.type).type}[]`;
}

const length = (m, owner) => m.dims.map((d) => (d.constant ? d.size : `Number(${owner}${d.size})`)).join(' * ');

function initial(m) {
  if (m.dims.length === 0) return scalar(m.type).empty;
  if (!numeric[m.type]) return '[]';
  return `new ${numeric[m.type].array}(${m.dims.every((d) => d.constant) ? length(m, '') : 0})`;
}

function readMember(m) {
  const one = primitive.has(m.type) ? `r.${m.type}()` : `read_${m.type}(r)`;
  if (m.dims.length === 0) return one;
  return numeric[m.type] ? `r.${m.type}_array(${length(m, '')})` : `r.list(${length(m, '')}, () => ${one})`;
}

function writeMember(struct, m) {
  const one = (x) => (primitive.has(m.type) ? `w.${m.type}(${x})` : `write_${m.type}(w, ${x})`);
  if (m.dims.length === 0) return [`  ${one(`m.${m.name}`)};`];
  return [
    `  check_length('${struct.name}.${m.name}', m.${m.name}.length, ${length(m, 'm.')});`,
    `  for (const x of m.${m.name}) ${one('x')};`,
  ];
}

function emitStruct(struct, structs) {
  const type = pascal(struct.name);
  const name = struct.name;
  const { members } = struct;
  return [
    `export interface ${type} {`,
    ...members.map((m) => `  ${m.name}: ${fieldType(m)};`),
    '}\n',
    `export function make_${name}(): ${type} {`,
    '  return {',
    ...members.map((m) => `    ${m.name}: ${initial(m)},`),
    '  };\n}\n',
    `function read_${name}(r: Reader): ${type} {`,
    ...members.map((m) => `  const ${m.name} = ${readMember(m)};`),
    `  return { ${members.map((m) => m.name).join(', ')} };\n}\n`,
    `function write_${name}(w: Writer, m: ${type}): void {`,
    ...members.flatMap((m) => writeMember(struct, m)),
    '}\n',
    `export const ${name} = codec<${type}>(`,
    `  '${name}', 0x${fingerprint(name, structs).toString(16)}n, make_${name}, read_${name}, write_${name},\n);\n`,
  ].join('\n');
}

/** Of each number type: one value, and an array of them. */
function emitReader([type, n]) {
  const ts = scalar(type).type;
  return `  ${type}(): ${ts} {
    this.need(${n.size});
    const v = this.view.${n.get}(this.at);
    this.at += ${n.size};
    return v;
  }
  ${type}_array(n: number): ${n.array}<ArrayBuffer> {
    this.need_many(n, ${n.size});
    const a = new ${n.array}(n);
    for (let i = 0; i < n; i++, this.at += ${n.size}) a[i] = this.view.${n.get}(this.at);
    return a;
  }`;
}

function emitWriter([type, n]) {
  return `  ${type}(v: ${scalar(type).type}): void {
    this.room(${n.size});
    this.view.${n.set}(this.at, v);
    this.at += ${n.size};
  }`;
}

function emitRuntime() {
  const all = Object.entries(numeric);
  return [
    runtime.head,
    `class Reader {\n${runtime.reader}\n${all.map(emitReader).join('\n')}\n}\n`,
    `class Writer {\n${runtime.writer}\n${all.map(emitWriter).join('\n')}\n}\n`,
  ].join('\n');
}

export function generate(structs) {
  return [
    '// SPDX-License-Identifier: GPL-3.0-or-later',
    '// Generated from lcm_types/*.lcm by scripts/gen-lcm.mjs; do not edit.',
    '',
    emitRuntime(),
    ...structs.map((s) => emitStruct(s, structs)),
  ].join('\n');
}

export function readTypes(dir = join(here, '../../../lcm_types')) {
  return readdirSync(dir)
    .filter((f) => f.endsWith('.lcm'))
    .sort()
    .flatMap((f) => parse(readFileSync(join(dir, f), 'utf8')));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const to = join(here, '../src/lcm.ts');
  const text = generate(readTypes());
  if (!existsSync(to) || readFileSync(to, 'utf8') !== text) writeFileSync(to, text);
}
