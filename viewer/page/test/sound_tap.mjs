// SPDX-License-Identifier: GPL-3.0-or-later
// Runs in the page before it: listens to what really leaves its mixer, in the thread of the audio. It notes when each
// message arrived, when each sound was handed to the audio, and when the audio's thread rendered which moment of its
// own clock. window.__tap has all of it; sound_latency.mjs puts them together.

export function tapSound() {
  const tap = (window.__tap = {
    ...{ context: null, sounds: [], events: [], starts: [], blocks: [], peak: 0, quiet: 0 },
    /** The message whose handlers run. */
    message: null,
  });
  // A sound begins with the first sample above -70 dB after 30 ms of silence. Date.now() is the only clock here that
  // the page has too; it has whole milliseconds.
  const worklet = `registerProcessor('tap', class extends AudioWorkletProcessor {
    quiet = 1e9; peak = 0; told = 0; blocks = [];
    process([[x]]) {
      const wall = Date.now();
      if (wall !== this.blocks.at(-1)?.wall) this.blocks.push({ at: currentTime, wall });
      if (x) this.listen(x, wall);
      else this.quiet += 128; // Firefox hands on nothing of nodes that are at rest.
      if (currentTime > this.told + 0.1) {
        this.told = currentTime;
        this.port.postMessage({ peak: this.peak, quiet: this.quiet / sampleRate, more: this.blocks });
        this.blocks = [{ at: currentTime, wall }];
      }
      return true;
    }
    listen(x, wall) {
      for (let i = 0; i < x.length; i++) {
        const size = Math.abs(x[i]);
        this.peak = Math.max(this.peak, size);
        if (size < 0.0003) { this.quiet++; continue; }
        if (this.quiet > 0.03 * sampleRate) this.port.postMessage({ begins: currentTime + i / sampleRate, wall });
        this.quiet = 0;
      }
    }
  });`;
  const connect = AudioNode.prototype.connect;
  AudioNode.prototype.connect = function (to, ...rest) {
    if (to instanceof AudioDestinationNode && this.context instanceof AudioContext && !tap.context) {
      tap.context = this.context;
      const url = URL.createObjectURL(new Blob([worklet], { type: 'text/javascript' }));
      void this.context.audioWorklet.addModule(url).then(() => {
        const node = new AudioWorkletNode(this.context, 'tap', { numberOfOutputs: 0 });
        node.port.onmessage = ({ data: { more = [], ...data } }) => {
          tap.blocks.push(...more);
          if (data.begins !== undefined) tap.sounds.push(data);
          else Object.assign(tap, data);
        };
        connect.call(this, node);
        tap.ready = true;
      });
    }
    return connect.call(this, to, ...rest);
  };
}

/** The second half: when messages arrived, and which sound each began. Runs after tapSound. */
export function tapMessages() {
  const tap = window.__tap;
  for (const source of [OscillatorNode, AudioBufferSourceNode]) {
    const start = source.prototype.start;
    source.prototype.start = function (at = 0, ...rest) {
      if (tap.message && this.context === tap.context)
        tap.starts.push({ ...tap.message, at, now: this.context.currentTime, handedMs: performance.now() });
      return start.call(this, at, ...rest);
    };
  }
  /** Channel and the sender's clock, us: every message begins with fingerprint, session, sequence and time. */
  const header = (data) => {
    const bytes = new Uint8Array(data);
    const channel = String.fromCharCode(...bytes.subarray(1, 1 + bytes[0]));
    const at = 1 + bytes[0] + 24;
    const sentUs = bytes.length >= at + 8 ? Number(new DataView(data).getBigInt64(at)) : 0;
    return { channel, sentUs };
  };
  const Socket = window.WebSocket;
  window.WebSocket = class extends Socket {
    constructor(...all) {
      super(...all);
      // Before the page's own handler.
      this.addEventListener('message', ({ data }) => {
        if (!(data instanceof ArrayBuffer) || !tap.context) return;
        tap.message = { ...header(data), arrivedMs: performance.now() };
        if (tap.message.channel === 'SIM_EVENT') tap.events.push({ ...tap.message, at: tap.context.currentTime });
      });
    }
    set onmessage(handle) {
      super.onmessage = (e) => {
        handle.call(this, e);
        tap.message = null;
      };
    }
  };
}

/**
 * Runs in the page: draws nothing, as a graphics card would take none of the processor's time, and has twenty pictures
 * a second, since two cores are shared with the engine.
 */
export function drawNothing() {
  const draws = ['drawElements', 'drawArrays', 'drawElementsInstanced', 'drawArraysInstanced', 'clear'];
  for (const name of draws) WebGL2RenderingContext.prototype[name] = () => undefined;
  const soon = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => setTimeout(() => soon(draw), 40);
}
