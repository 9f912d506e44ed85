// SPDX-License-Identifier: GPL-3.0-or-later
// What the haptic server says of both hands, heard while somebody looks at the settings. Only hears: an observer's
// messages do not reach the bus.
import { socketUrl } from '../connection';
import { type DeviceState, device_state_t, type HapticStatus, haptic_status_t } from '../lcm';
import { unpack } from '../protocol';

/** The messages come 30 times a second, so after this long nobody speaks. */
const silentMs = 2000;

export class DeviceLink {
  private socket: WebSocket | null = null;
  private devices: DeviceState | null = null;
  private status: HapticStatus | null = null;
  private heardMs = -Infinity;

  open(): void {
    this.close();
    this.socket = new WebSocket(socketUrl(window.location.href, 'observer'));
    this.socket.binaryType = 'arraybuffer';
    this.socket.onmessage = (e) => {
      if (e.data instanceof ArrayBuffer) this.receive(new Uint8Array(e.data), performance.now());
    };
  }

  close(): void {
    if (this.socket) this.socket.onmessage = null;
    this.socket?.close();
    this.socket = null;
    this.devices = this.status = null;
    this.heardMs = -Infinity;
  }

  /** null: no haptic server speaks now. */
  hands(nowMs: number): DeviceState['hand'] | null {
    return this.devices && nowMs - this.heardMs < silentMs ? this.devices.hand : null;
  }

  servo(nowMs: number): HapticStatus | null {
    return this.hands(nowMs) ? this.status : null;
  }

  /** What cannot be decoded counts as not said. */
  receive(bytes: Uint8Array, nowMs: number): void {
    const packet = unpack(bytes);
    try {
      if (packet?.channel === 'DEVICE_STATE') {
        this.devices = device_state_t.decode(packet.payload);
        this.heardMs = nowMs;
      } else if (packet?.channel === 'HAPTIC_STATUS') this.status = haptic_status_t.decode(packet.payload);
    } catch {
      return;
    }
  }
}
