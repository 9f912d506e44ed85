// SPDX-License-Identifier: GPL-3.0-or-later
// Runs in the page before it: listens to what really leaves its mixer, in the thread of the audio, and notes when each
// event arrived, both on the clock of the audio. window.__tap has both.

export function tapSound() {
  const tap = (window.__tap = { context: null, sounds: [], events: [], peak: 0, samples: 0 });
  // A sound begins with the first sample above -70 dB after 30 ms of silence.
  const worklet = `registerProcessor('tap', class extends AudioWorkletProcessor {
    quiet = 1e9; peak = 0; told = 0;
    process([[x]]) {
      if (!x) return true;
      for (let i = 0; i < x.length; i++) {
        const size = Math.abs(x[i]);
        this.peak = Math.max(this.peak, size);
        if (size < 0.0003) { this.quiet++; continue; }
        if (this.quiet > 0.03 * sampleRate) this.port.postMessage({ begins: currentTime + i / sampleRate });
        this.quiet = 0;
      }
      if (currentTime > this.told + 0.1) {
        this.told = currentTime;
        this.port.postMessage({ peak: this.peak, quiet: this.quiet / sampleRate });
      }
      return true;
    }
  });`;
  const connect = AudioNode.prototype.connect;
  AudioNode.prototype.connect = function (to, ...rest) {
    if (to instanceof AudioDestinationNode && this.context instanceof AudioContext && !tap.context) {
      tap.context = this.context;
      const url = URL.createObjectURL(new Blob([worklet], { type: 'text/javascript' }));
      void this.context.audioWorklet.addModule(url).then(() => {
        const node = new AudioWorkletNode(this.context, 'tap', { numberOfOutputs: 0 });
        node.port.onmessage = ({ data }) => {
          if (data.begins !== undefined) tap.sounds.push(data.begins);
          else Object.assign(tap, data);
        };
        connect.call(this, node);
        tap.ready = true;
      });
    }
    return connect.call(this, to, ...rest);
  };
  const Socket = window.WebSocket;
  window.WebSocket = class extends Socket {
    constructor(...all) {
      super(...all);
      // Before the page's own handler.
      this.addEventListener('message', ({ data }) => {
        if (!(data instanceof ArrayBuffer) || !tap.context) return;
        const bytes = new Uint8Array(data);
        const channel = String.fromCharCode(...bytes.subarray(1, 1 + bytes[0]));
        if (channel !== 'SIM_EVENT') return;
        // The audio's clock goes on in steps; the page's own says where it is between two of them.
        const { contextTime, performanceTime } = tap.context.getOutputTimestamp();
        const played = contextTime + (performance.now() - performanceTime) / 1000;
        tap.events.push({ at: tap.context.currentTime, played });
      });
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
