// SPDX-License-Identifier: GPL-3.0-or-later
// The WebSocket to the gateway: decodes what comes, reconnects by itself with a growing pause, counts what it refused.
import * as lcm from './lcm';
import { pack, unpack } from './protocol';
import { type OwnMessage, parseRoomMessage, type RoomMessage } from './room/messages';

export interface Handlers {
  frame(m: lcm.RenderFrame): void;
  scene(m: lcm.SceneInfo): void;
  event(m: lcm.SimEvent): void;
  haptic(m: lcm.HapticStatus): void;
  devices(m: lcm.DeviceState): void;
  metrics(m: lcm.Metrics): void;
  room(m: RoomMessage): void;
  state(open: boolean): void;
}

/** The gateway takes from a page what its role may send. */
export function socketUrl(page: string, role: string): string {
  const url = new URL('ws', page);
  url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
  url.search = `?role=${role}`;
  return url.href;
}

const firstPauseMs = 250;
const longestPauseMs = 4000;

export class Connection {
  open = false;
  refused = 0;
  private socket: WebSocket | null = null;
  private pauseMs = firstPauseMs;

  constructor(
    private readonly url: string,
    private readonly handlers: Handlers,
  ) {
    this.connect();
  }

  sendCommand(command: string, argument = ''): void {
    this.send('USER_COMMAND', lcm.user_command_t.encode({ time_us: nowUs(), sender: viewerId, command, argument }));
  }

  sendHand(message: Omit<lcm.HandInput, 'time_us'>): void {
    this.send('HAND_INPUT', lcm.hand_input_t.encode({ time_us: nowUs(), ...message }));
  }

  /** To the other pages of this station. */
  sendRoom(message: OwnMessage): void {
    this.send('ROOM', new TextEncoder().encode(JSON.stringify(message)));
  }

  private send(channel: string, payload: Uint8Array): void {
    if (this.socket?.readyState !== WebSocket.OPEN) return;
    // A stalled socket must not hoard old hand poses: only the newest is of use.
    if (channel === 'HAND_INPUT' && this.socket.bufferedAmount > 16384) return;
    this.socket.send(pack(channel, payload));
  }

  private connect(): void {
    const socket = new WebSocket(this.url);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.onopen = () => {
      this.pauseMs = firstPauseMs;
      this.open = true;
      this.handlers.state(true);
    };
    socket.onmessage = (e) => {
      if (e.data instanceof ArrayBuffer) this.receive(new Uint8Array(e.data));
    };
    socket.onclose = () => {
      if (this.open) {
        this.open = false;
        this.handlers.state(false);
      }
      setTimeout(() => this.connect(), this.pauseMs);
      this.pauseMs = Math.min(this.pauseMs * 1.6, longestPauseMs);
    };
  }

  private receive(bytes: Uint8Array): void {
    const packet = unpack(bytes);
    if (!packet) {
      this.refused++;
      return;
    }
    const { channel, payload } = packet;
    const decoded = decode(() => {
      switch (channel) {
        case 'RENDER_FRAME': {
          const m = lcm.render_frame_t.decode(payload);
          return () => this.handlers.frame(m);
        }
        case 'SCENE_INFO': {
          const m = lcm.scene_info_t.decode(payload);
          return () => this.handlers.scene(m);
        }
        case 'SIM_EVENT': {
          const m = lcm.sim_event_t.decode(payload);
          return () => this.handlers.event(m);
        }
        case 'HAPTIC_STATUS': {
          const m = lcm.haptic_status_t.decode(payload);
          return () => this.handlers.haptic(m);
        }
        case 'METRICS': {
          const m = lcm.metrics_t.decode(payload);
          return () => this.handlers.metrics(m);
        }
        case 'DEVICE_STATE': {
          const m = lcm.device_state_t.decode(payload);
          return () => this.handlers.devices(m);
        }
        case 'ROOM': {
          const m = parseRoomMessage(payload);
          return m && (() => this.handlers.room(m));
        }
        default:
          return () => undefined;
      }
    });
    if (decoded) decoded();
    else this.refused++;
  }
}

function decode<T>(f: () => T): T | null {
  try {
    return f();
  } catch {
    return null;
  }
}

const nowUs = (): bigint => BigInt(Math.round(performance.now() * 1000));
const viewerId = `viewer-${Math.random().toString(36).slice(2, 8)}`;
