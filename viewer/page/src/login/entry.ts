// SPDX-License-Identifier: GPL-3.0-or-later
// Entry of the login page.
import { inReadersLanguage } from '../languages/languages';

await inReadersLanguage(() => import('./main'));
