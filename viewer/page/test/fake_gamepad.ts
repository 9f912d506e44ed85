// SPDX-License-Identifier: GPL-3.0-or-later
// A made-up gamepad of the standard mapping (W3C Gamepad), for tests: at rest, nothing pressed.

export function fakeGamepad(index = 0) {
  return {
    index,
    mapping: 'standard',
    axes: [0, 0, 0, 0],
    buttons: Array.from({ length: 17 }, () => ({ value: 0, pressed: false, touched: false })),
    /** Presses a button so far, 0..1. */
    press(button: number, value = 1): void {
      this.buttons[button] = { value, pressed: value > 0, touched: value > 0 };
    },
  };
}
