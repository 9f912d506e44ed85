// SPDX-License-Identifier: GPL-3.0-or-later
// The live check of devices: what is said of each, how its bars and lamps follow, and what is heard of the hands.
import { describe, expect, it } from 'vitest';
import { device_state_t, hand_state_t, haptic_status_t } from '../src/lcm';
import { pack } from '../src/protocol';
import { DeviceLink } from '../src/start/device_link';
import { deviceText, handLive, KeyWatch, padLive, PointerWatch } from '../src/start/device_live';
import { fakeGamepad } from './fake_gamepad';

const hand = (more: object = {}) => ({ ...hand_state_t.make(), device: 'touch', connected: true, ...more });

describe('a hand of the haptic server', () => {
  it('has its kind in words, and a new kind its name', () => {
    expect(deviceText('simulated')).toBe('simulated arm');
    expect(deviceText('gamepad')).toContain('without forces');
    expect(deviceText('omega9')).toBe('omega9');
    expect(handLive(hand({ connected: false }), [0, 0, 0]).says).toBe('Touch or Phantom arm: not connected');
  });

  it('moves a bar for each axis, from where it was, and lights a lamp for each button', () => {
    const live = handLive(hand({ p_m: Float64Array.of(0.11, -0.2, NaN), button2: true }), [0.1, 0.2, 0.3]);
    expect(live.bars[0]).toBeCloseTo(0.5);
    expect(live.bars.slice(1)).toEqual([-1, 0]);
    expect(live.lamps).toEqual([false, true]);
  });

  it('is heard from whole messages only, and is gone when nothing more comes', () => {
    const link = new DeviceLink();
    const message = device_state_t.encode({ ...device_state_t.make(), hands: 1, hand: [hand()] });
    link.receive(message, 0);
    link.receive(pack('DEVICE_STATE', message.slice(0, 40)), 0);
    link.receive(pack('HAND_INPUT', message), 0);
    expect(link.hands(0)).toBeNull();
    link.receive(pack('DEVICE_STATE', message), 100);
    link.receive(pack('HAPTIC_STATUS', haptic_status_t.encode({ ...haptic_status_t.make(), ticks_per_s: 997 })), 100);
    expect(link.hands(200)!.map((h) => h.device)).toEqual(['touch']);
    expect(link.servo(200)!.ticks_per_s).toBe(997);
    expect(link.hands(2200)).toBeNull();
    expect(link.servo(2200)).toBeNull();
    link.close();
    link.receive(pack('DEVICE_STATE', message), 3000);
    expect(link.hands(3000)).toHaveLength(1);
    expect(link.servo(3000), 'of a former haptic server').toBeNull();
  });
});

describe('a gamepad', () => {
  it('moves bars by its sticks and lights its buttons', () => {
    const pad = { ...fakeGamepad(), id: 'Pad   of\n a maker' };
    pad.axes = [0.5, -2, 0, 1];
    pad.press(6, 0.7);
    const live = padLive(pad);
    expect(live.says).toBe('Pad of a maker');
    expect(live.bars).toEqual([0.5, -1, 0, 1]);
    expect(live.lamps.map((on, k) => (on ? k : -1)).filter((k) => k >= 0)).toEqual([6]);
  });

  it('is named as no help if its buttons have no known places', () => {
    expect(padLive({ ...fakeGamepad(), id: 'Stick', mapping: '' }).says).toBe('Stick: its buttons are not known');
  });
});

describe('pointers and keys', () => {
  const event = { clientX: 300, clientY: 100, buttons: 4, pressure: 0.5 };

  it('say what the browser sees until they are used, each kind by itself', () => {
    const watch = new PointerWatch();
    const live = (kind: 'mouse' | 'pen' | 'touch', touchPoints = 0) =>
      watch.live(kind, 400, 200, { fine: true, touchPoints });
    expect(live('touch').says).toBe('the browser sees none');
    expect(live('touch', 5).says).toBe('there; touch the page');
    expect(live('mouse')).toEqual({ says: 'there; move it', bars: [0, 0], lamps: [false, false, false] });
    watch.take({ ...event, pointerType: 'mouse' });
    expect(live('mouse')).toEqual({ says: 'works', bars: [0.5, 0], lamps: [false, true, false] });
    expect(live('pen').says).toBe('seen once it touches the page');
    watch.take({ ...event, pointerType: 'pen' });
    expect(live('pen')).toEqual({ says: 'works', bars: [0.5, 0, 0.5], lamps: [true] });
  });

  it('show the last key, and a lamp as long as one is held', () => {
    const keys = new KeyWatch();
    expect(keys.live()).toEqual({ says: 'press a key', bars: [], lamps: [false] });
    keys.down({ code: 'Space', key: ' ' });
    expect(keys.live()).toEqual({ says: 'works: space bar', bars: [], lamps: [true] });
    keys.up({ code: 'Space' });
    expect(keys.live().lamps).toEqual([false]);
    keys.down({ code: 'KeyA', key: 'a' });
    keys.leave();
    expect(keys.live()).toEqual({ says: 'works: a', bars: [], lamps: [false] });
  });
});
