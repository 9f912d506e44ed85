// SPDX-License-Identifier: GPL-3.0-or-later
// An audio context that makes no sound: it counts the sources that were started, and its clock is set by the test.

const param = () => ({
  value: 0,
  setValueAtTime: () => undefined,
  linearRampToValueAtTime: () => undefined,
  exponentialRampToValueAtTime: () => undefined,
  setTargetAtTime: () => undefined,
  cancelScheduledValues: () => undefined,
});

export class FakeAudio {
  currentTime = 0;
  readonly baseLatency = 0.005;
  readonly outputLatency = 0.01;
  /** What getOutputTimestamp() says. */
  output = { contextTime: 0, performanceTime: 0 };
  readonly getOutputTimestamp = () => this.output;
  readonly sampleRate = 8000;
  /** When each source was started. */
  readonly starts: number[] = [];
  /** Sources that will end by themselves. */
  ends = 0;
  readonly destination = this.node();
  readonly createGain = () => this.node();
  readonly createBiquadFilter = () => this.node();
  readonly createWaveShaper = () => this.node();
  readonly createStereoPanner = () => this.node();
  readonly createOscillator = () => this.source();
  readonly createBufferSource = () => this.source();
  readonly createPeriodicWave = () => ({});

  createBuffer(channels: number, length: number, rate: number) {
    const data = new Float32Array(length);
    return { duration: length / rate, numberOfChannels: channels, getChannelData: () => data };
  }

  private node() {
    const made: Record<string, unknown> = { gain: param(), frequency: param(), Q: param(), pan: param() };
    made.connect = (next: unknown) => next;
    return made;
  }

  private source() {
    const made = this.node();
    made.setPeriodicWave = () => undefined;
    made.start = (at: number) => this.starts.push(at);
    made.stop = () => this.ends++;
    return made;
  }
}
