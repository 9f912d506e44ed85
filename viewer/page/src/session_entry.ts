// SPDX-License-Identifier: GPL-3.0-or-later
// Entry of the session's page.
import { inReadersLanguage } from './languages/languages';

await inReadersLanguage(() => import('./main'));
