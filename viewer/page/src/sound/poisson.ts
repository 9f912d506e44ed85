// SPDX-License-Identifier: GPL-3.0-or-later
// A Poisson process whose rate may change: drops that fall, bubbles that burst. Each waits for a draw of the
// exponential distribution on the clock of the hazard, the integral of the rate:
//
//   H(t) = integral of rate dt;   an event when H passes E1, E1 + E2, ...;   E = -ln(1 - u), u uniform in [0, 1).
//
// No event is planned ahead, so none comes after the rate has fallen to zero.

export class Poisson {
  private left: number;

  constructor(private readonly random: () => number) {
    this.left = this.wait();
  }

  /** How many events lie in the next dtS at this rate, 1/s. */
  count(rate: number, dtS: number): number {
    this.left -= Math.max(0, rate * dtS);
    let n = 0;
    for (; this.left <= 0; n++) this.left += this.wait();
    return n;
  }

  private wait(): number {
    return -Math.log(1 - this.random());
  }
}
