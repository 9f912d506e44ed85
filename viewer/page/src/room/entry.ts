// SPDX-License-Identifier: GPL-3.0-or-later
// Entry of the overview of a room.
import { inReadersLanguage } from '../languages/languages';

await inReadersLanguage(() => import('./main'));
