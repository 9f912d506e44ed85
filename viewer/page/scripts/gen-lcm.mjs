// SPDX-License-Identifier: GPL-3.0-or-later
// Generates src/lcm.ts (types, encoders, decoders, fingerprints) from ../../lcm_types/*.lcm.
//
// Mapping: int64_t -> bigint, other numbers -> number, boolean -> boolean, string -> string, structs -> objects,
// arrays of numbers -> one flat typed array (Float32Array, ...) even when they have several dimensions,
// arrays of structs, strings and booleans -> plain arrays (one dimension only).
import { readFileSync, readdirSync, writeFileSync, existsSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

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
  const tokens = text.replace(/\/\*[\s\S]*?\*\//g, ' ').replace(/\/\/[^\n]*/g, ' ').match(/[A-Za-z_][\w.]*|\d+|[{}[\];,=]/g) ?? [];
  const structs = [];
  let i = 0;
  const expect = (t) => {
    if (tokens[i++] !== t) throw new Error(`expected "${t}" before "${tokens.slice(i - 1, i + 4).join(' ')}"`);
  };
  while (i < tokens.length) {
    if (tokens[i] === 'package') { i += 2; expect(';'); continue; }
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
function base_hash(struct) {
  let v = 0x12345678n;
  const update = (c) => {
    const signed = BigInt.asIntN(64, v);
    v = BigInt.asUintN(64, ((v << 8n) ^ (signed >> 55n)) + BigInt(c));
  };
  const text = (s) => { update(s.length); for (const c of s) update(c.charCodeAt(0)); };
  for (const m of struct.members) {
    text(m.name);
    if (primitive.has(m.type)) text(m.type);
    update(m.dims.length);
    for (const d of m.dims) { update(d.constant ? 0 : 1); text(d.size); }
  }
  return v;
}

/** LCM's fingerprint of a struct with everything it contains. */
export function fingerprint(name, structs, parents = []) {
  if (parents.includes(name)) return 0n;
  const struct = structs.find((s) => s.name === name);
  if (!struct) throw new Error(`unknown type ${name}`);
  let v = base_hash(struct);
  for (const m of struct.members) if (!primitive.has(m.type)) v = (v + fingerprint(m.type, structs, [...parents, name])) & mask;
  return ((v << 1n) & mask) + (v >> 63n);
}

const pascal = (s) => s.replace(/_t$/, '').split('_').map((w) => w[0].toUpperCase() + w.slice(1)).join('');

function field_type(m) {
  if (m.dims.length === 0) return m.type === 'int64_t' ? 'bigint' : m.type === 'string' ? 'string' : m.type === 'boolean' ? 'boolean' : numeric[m.type] ? 'number' : pascal(m.type);
  if (numeric[m.type]) return numeric[m.type].array;
  if (m.dims.length > 1) throw new Error(`${m.name}: several dimensions of ${m.type} are not supported`);
  return `${m.type === 'string' ? 'string' : m.type === 'boolean' ? 'boolean' : pascal(m.type)}[]`;
}

function emit_struct(struct, structs) {
  const name = pascal(struct.name);
  const out = [`export interface ${name} {`, ...struct.members.map((m) => `  ${m.name}: ${field_type(m)};`), '}', ''];
  const length = (m, owner) => m.dims.map((d) => (d.constant ? d.size : `Number(${owner}${d.size})`)).join(' * ');
  const initial = (m) => {
    if (m.dims.length === 0) return m.type === 'int64_t' ? '0n' : m.type === 'string' ? "''" : m.type === 'boolean' ? 'false' : numeric[m.type] ? '0' : `make_${m.type}()`;
    const fixed = m.dims.every((d) => d.constant);
    if (numeric[m.type]) return `new ${numeric[m.type].array}(${fixed ? length(m, '') : 0})`;
    return '[]';
  };
  out.push(`export function make_${struct.name}(): ${name} {`, '  return {', ...struct.members.map((m) => `    ${m.name}: ${initial(m)},`), '  };', '}', '');
  out.push(`function read_${struct.name}(r: Reader): ${name} {`);
  for (const m of struct.members) {
    const n = numeric[m.type];
    let value;
    if (m.dims.length === 0) value = n ? `r.${m.type}()` : primitive.has(m.type) ? `r.${m.type}()` : `read_${m.type}(r)`;
    else if (n) value = `r.${m.type}_array(${length(m, '')})`;
    else value = `r.list(${length(m, '')}, () => ${primitive.has(m.type) ? `r.${m.type}()` : `read_${m.type}(r)`})`;
    out.push(`  const ${m.name} = ${value};`);
  }
  out.push(`  return { ${struct.members.map((m) => m.name).join(', ')} };`, '}', '');
  out.push(`function write_${struct.name}(w: Writer, m: ${name}): void {`);
  for (const m of struct.members) {
    if (m.dims.length === 0) { out.push(primitive.has(m.type) ? `  w.${m.type}(m.${m.name});` : `  write_${m.type}(w, m.${m.name});`); continue; }
    out.push(`  check_length('${struct.name}.${m.name}', m.${m.name}.length, ${length(m, 'm.')});`);
    out.push(`  for (const x of m.${m.name}) ${primitive.has(m.type) ? `w.${m.type}(x)` : `write_${m.type}(w, x)`};`);
  }
  out.push('}', '');
  out.push(`const ${struct.name}_hash = 0x${fingerprint(struct.name, structs).toString(16)}n;`);
  out.push(`export const ${struct.name}: Codec<${name}> = {`, `  name: '${struct.name}',`, `  fingerprint: ${struct.name}_hash,`, `  make: make_${struct.name},`);
  out.push(`  encode: (m) => { const w = new Writer(); w.hash(${struct.name}_hash); write_${struct.name}(w, m); return w.bytes(); },`);
  out.push(`  decode: (b) => { const r = new Reader(b); r.hash(${struct.name}_hash, '${struct.name}'); const m = read_${struct.name}(r); r.end('${struct.name}'); return m; },`, '};', '');
  return out.join('\n');
}

function emit_runtime() {
  const readers = Object.entries(numeric).map(([t, n]) => `  ${t}(): ${t === 'int64_t' ? 'bigint' : 'number'} { this.need(${n.size}); const v = this.view.${n.get}(this.at); this.at += ${n.size}; return v; }
  ${t}_array(n: number): ${n.array}<ArrayBuffer> { this.need_many(n, ${n.size}); const a = new ${n.array}(n); for (let i = 0; i < n; i++, this.at += ${n.size}) a[i] = this.view.${n.get}(this.at); return a; }`).join('\n');
  const writers = Object.entries(numeric).map(([t, n]) => `  ${t}(v: ${t === 'int64_t' ? 'bigint' : 'number'}): void { this.room(${n.size}); this.view.${n.set}(this.at, v); this.at += ${n.size}; }`).join('\n');
  return `/** Encoder, decoder and fingerprint of one message type. decode throws on a wrong hash, truncation or left-over bytes. */
export interface Codec<T> {
  readonly name: string;
  readonly fingerprint: bigint;
  make(): T;
  encode(message: T): Uint8Array<ArrayBuffer>;
  decode(bytes: Uint8Array): T;
}

const utf8_decoder = new TextDecoder();
const utf8_encoder = new TextEncoder();

function check_length(what: string, got: number, wanted: number): void {
  if (got !== wanted) throw new RangeError(\`\${what} has \${got} entries, its count says \${wanted}\`);
}

class Reader {
  private at = 0;
  private readonly view: DataView;
  constructor(private readonly data: Uint8Array) { this.view = new DataView(data.buffer, data.byteOffset, data.byteLength); }
  private need(n: number): void { if (this.at + n > this.data.byteLength) throw new RangeError('message is truncated'); }
  private need_many(n: number, size: number): void {
    if (!(n >= 0)) throw new RangeError('negative count');
    this.need(n * size);
  }
  hash(wanted: bigint, name: string): void {
    this.need(8);
    if (this.view.getBigUint64(0) !== wanted) throw new TypeError(\`not a \${name}: fingerprint differs\`);
    this.at = 8;
  }
  end(name: string): void { if (this.at !== this.data.byteLength) throw new RangeError(\`\${name}: bytes left over\`); }
  boolean(): boolean { return this.int8_t() !== 0; }
  string(): string {
    const n = this.int32_t();
    if (n < 1) throw new RangeError('string without its terminator');
    this.need(n);
    const s = utf8_decoder.decode(this.data.subarray(this.at, this.at + n - 1));
    this.at += n;
    return s;
  }
  list<T>(n: number, read: () => T): T[] {
    this.need_many(n, 1);
    const a: T[] = [];
    for (let i = 0; i < n; i++) a.push(read());
    return a;
  }
${readers}
}

class Writer {
  private at = 0;
  private buffer = new ArrayBuffer(256);
  private view = new DataView(this.buffer);
  private room(n: number): void {
    if (this.at + n <= this.buffer.byteLength) return;
    const bigger = new ArrayBuffer(Math.max(this.buffer.byteLength * 2, this.at + n));
    new Uint8Array(bigger).set(new Uint8Array(this.buffer));
    this.buffer = bigger;
    this.view = new DataView(bigger);
  }
  bytes(): Uint8Array<ArrayBuffer> { return new Uint8Array(this.buffer, 0, this.at).slice(); }
  hash(v: bigint): void { this.room(8); this.view.setBigUint64(this.at, v); this.at += 8; }
  boolean(v: boolean): void { this.int8_t(v ? 1 : 0); }
  string(v: string): void {
    const b = utf8_encoder.encode(v);
    this.int32_t(b.length + 1);
    this.room(b.length + 1);
    new Uint8Array(this.buffer).set(b, this.at);
    this.at += b.length;
    this.view.setUint8(this.at++, 0);
  }
${writers}
}
`;
}

export function generate(structs) {
  return ['// SPDX-License-Identifier: GPL-3.0-or-later', '// Generated from lcm_types/*.lcm by scripts/gen-lcm.mjs; do not edit.', '', emit_runtime(),
    ...structs.map((s) => emit_struct(s, structs))].join('\n');
}

export function read_types(dir = join(here, '../../../lcm_types')) {
  return readdirSync(dir).filter((f) => f.endsWith('.lcm')).sort().flatMap((f) => parse(readFileSync(join(dir, f), 'utf8')));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const to = join(here, '../src/lcm.ts');
  const text = generate(read_types());
  if (!existsSync(to) || readFileSync(to, 'utf8') !== text) writeFileSync(to, text);
}
