// SPDX-License-Identifier: GPL-3.0-or-later
// The styles of the panels, in the order in which they override each other.
import '../screens.css';
import './hud.css';
import './hands.css';
import './panels.css';
import './vitals.css';
import './instructor.css';
import './dialogs.css';
import './tutor.css';
import './narrow.css';
import { browserStore } from '../browser_store';
import { applyPalette, keptPalette } from '../palette';

applyPalette(keptPalette(browserStore()));
