// SPDX-License-Identifier: GPL-3.0-or-later
// Entry of the page of the case builder.
import { inReadersLanguage } from '../languages/languages';

await inReadersLanguage(() => import('./main'));
