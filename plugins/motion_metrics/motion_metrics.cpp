// SPDX-License-Identifier: GPL-3.0-or-later
/*
# motion_metrics

Metrics of how the hands move and press, for each hand and for both together. They read the report of each step: the
pose of the hand that the device gives, the tip and shaft of the tool in it, the buttons, and the forces on structures.
They count while the exercise runs and stand still after its end.

A hand moves when it is faster than `speed`. A movement ends when the hand has been slower for `pause`. A hand works
when it moves, when its tool touches something, or when it presses a button; otherwise it is idle.

Smoothness is judged for each movement of 0.2 s or longer, and the mean is shown: log dimensionless jerk and spectral
arc length (Balasubramanian et al. 2015). Both are negative, and nearer to zero is smoother. A movement at exactly
constant speed has no jerk and is not judged. Tremor is the root mean square of the displacement between `tremor_from`
and `tremor_to`. Force figures hold for the time in which the force is above `touch`; the 95th percentile is exact to
0.6 %.
*/
#include "core/registry/registry.h"
#include "plugins/motion_metrics/register.h"

INSULA_PLUGIN(motion_metrics) {
  insula::register_hand_metrics(registry);
  insula::register_bimanual_metrics(registry);
}
