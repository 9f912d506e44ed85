// SPDX-License-Identifier: GPL-3.0-or-later
// Talk by voice between two pages of a station (WebRTC). The gateway passes on who rings and how the browsers reach
// each other; the sound goes from browser to browser in the room. No server outside is asked. The microphone is asked
// for only when somebody rings or accepts.
import { status } from '../status';
import type { OwnMessage, VoiceMessage } from './messages';

export type VoiceState = 'off' | 'calling' | 'ringing' | 'joining' | 'open';
/** Why a talk did not begin or ended; '': no reason to tell. */
export type VoiceEnd = '' | 'no microphone' | 'no answer' | 'declined' | 'lost';

const ringsForMs = 30_000;
const gathersForMs = 2000;
const looksEveryMs = 200;
const microphone = { audio: { echoCancellation: true, noiseSuppression: true, autoGainControl: true }, video: false };

/** Browsers give the microphone to encrypted pages and to those of the own machine only. */
export const canTalk = (): boolean =>
  window.isSecureContext && 'mediaDevices' in navigator && 'RTCPeerConnection' in window;

export class Voice {
  state: VoiceState = 'off';
  ended: VoiceEnd = '';
  /** Who rings: the role. */
  from = '';
  /** Of the sound that comes, 0 to 1. */
  level = 0;
  changed: () => void = () => undefined;
  private peer = 0;
  private connection: RTCPeerConnection | null = null;
  private own: MediaStream | null = null;
  private readonly sound = new Audio();
  private timer = 0;

  constructor(
    private readonly role: string,
    private readonly send: (m: OwnMessage) => void,
  ) {
    window.addEventListener('pagehide', () => this.hangUp());
  }

  /** Whether this side is heard when it talks. */
  get microphone(): 'none' | 'muted' | 'open' {
    const track = this.own?.getAudioTracks()[0];
    return track ? (track.enabled ? 'open' : 'muted') : 'none';
  }

  async call(): Promise<void> {
    if (this.state !== 'off') return;
    this.set('calling');
    const got = await this.openMicrophone();
    if (!this.is('calling')) return this.closeMicrophone();
    if (!got) return this.close('no microphone');
    this.send({ kind: 'voice', step: 'ring' });
    this.timer = window.setTimeout(() => this.hangUp('no answer'), ringsForMs);
  }

  /** Without a microphone one can listen. */
  async accept(): Promise<void> {
    if (this.state !== 'ringing') return;
    this.set('joining');
    await this.openMicrophone();
    if (!this.is('joining')) return this.closeMicrophone();
    this.send({ kind: 'voice', step: 'accept', to: this.peer });
  }

  mute(muted: boolean): void {
    for (const track of this.own?.getAudioTracks() ?? []) track.enabled = !muted;
    this.changed();
  }

  hangUp(why: VoiceEnd = ''): void {
    if (this.state === 'off') return;
    this.send({ kind: 'voice', step: 'end', ...(this.peer > 0 ? { to: this.peer } : {}) });
    this.close(why);
  }

  /** The way to the gateway is open again; what was sent just before it closed is lost. */
  reconnected(): void {
    if (this.state === 'calling' && this.own) this.send({ kind: 'voice', step: 'ring' });
  }

  hear(m: VoiceMessage): void {
    if (m.step === 'ring') return this.rung(m);
    if (m.step === 'accept') {
      if (this.state === 'calling' && this.own) void this.join(m.page).catch(() => this.hangUp('lost'));
    } else if (m.step === 'end') {
      const declined = this.state === 'calling' && m.from !== this.role;
      if (this.peer === m.page || declined) this.close(declined ? 'declined' : '');
    } else if ('sdp' in m && this.state === 'joining' && m.page === this.peer) {
      void this.agree(m.step, m.sdp).catch(() => this.hangUp('lost'));
    }
  }

  /** It may have changed while something was waited for. */
  private is(state: VoiceState): boolean {
    return this.state === state;
  }

  private rung(m: VoiceMessage): void {
    // Both rang at once: the trainee's page answers the instructor's.
    if (this.state === 'calling' && this.own && this.role === 'trainee') {
      this.peer = m.page;
      this.set('joining');
      this.send({ kind: 'voice', step: 'accept', to: m.page });
    } else if (this.state === 'off') {
      this.peer = m.page;
      this.from = m.from;
      this.set('ringing');
      this.timer = window.setTimeout(() => this.close(''), ringsForMs);
    } else if (this.state !== 'calling') {
      this.send({ kind: 'voice', step: 'end', to: m.page });
    }
  }

  /** The side that rang describes its sound. */
  private async join(page: number): Promise<void> {
    this.peer = page;
    this.set('joining');
    const connection = this.connect();
    await connection.setLocalDescription(await connection.createOffer());
    await this.describe(connection, 'offer');
  }

  private async agree(step: 'offer' | 'answer', sdp: string): Promise<void> {
    const connection = step === 'offer' ? this.connect() : this.connection;
    if (!connection) return;
    await connection.setRemoteDescription({ type: step, sdp });
    if (step === 'answer') return;
    await connection.setLocalDescription(await connection.createAnswer());
    await this.describe(connection, 'answer');
  }

  /** With all addresses at once, so that there is one message. */
  private async describe(connection: RTCPeerConnection, step: 'offer' | 'answer'): Promise<void> {
    await new Promise<void>((done) => {
      const look = () => connection.iceGatheringState === 'complete' && done();
      connection.addEventListener('icegatheringstatechange', look);
      window.setTimeout(done, gathersForMs);
      look();
    });
    const sdp = connection.localDescription?.sdp;
    if (sdp && connection === this.connection) this.send({ kind: 'voice', step, to: this.peer, sdp });
  }

  private connect(): RTCPeerConnection {
    this.connection?.close();
    const connection = new RTCPeerConnection({ iceServers: [] });
    this.connection = connection;
    for (const track of this.own?.getAudioTracks() ?? []) connection.addTrack(track, this.own!);
    connection.ontrack = (e) => {
      this.sound.srcObject = new MediaStream([e.track]);
      void this.sound.play().catch(() => undefined);
    };
    connection.onconnectionstatechange = () => {
      if (connection !== this.connection) return;
      if (connection.connectionState === 'connected') this.begin(connection);
      if (connection.connectionState === 'failed') this.hangUp('lost');
    };
    return connection;
  }

  private begin(connection: RTCPeerConnection): void {
    this.set('open');
    const look = async () => {
      if (connection !== this.connection) return;
      for (const each of (await connection.getStats()).values() as Iterable<RTCInboundRtpStreamStats>)
        if (each.type === 'inbound-rtp') {
          this.level = each.audioLevel ?? 0;
          status.voice.energy = each.totalAudioEnergy ?? 0;
        }
      this.changed();
      this.timer = window.setTimeout(() => void look(), looksEveryMs);
    };
    void look();
  }

  private async openMicrophone(): Promise<boolean> {
    try {
      this.own = await navigator.mediaDevices.getUserMedia(microphone);
    } catch {
      this.own = null;
    }
    return this.own !== null;
  }

  private closeMicrophone(): void {
    for (const track of this.own?.getTracks() ?? []) track.stop();
    this.own = null;
  }

  private close(why: VoiceEnd): void {
    this.closeMicrophone();
    this.connection?.close();
    this.connection = null;
    this.sound.srcObject = null;
    this.peer = 0;
    this.level = 0;
    this.set('off', why);
  }

  private set(state: VoiceState, why: VoiceEnd = ''): void {
    window.clearTimeout(this.timer);
    this.state = status.voice.state = state;
    this.ended = why;
    this.changed();
  }
}
