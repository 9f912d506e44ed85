// SPDX-License-Identifier: GPL-3.0-or-later
// Entry of the start page.
import './start.css';
import '../screens.css';
import './course.css';
import './settings.css';
import './devices.css';
import { Api } from './api';
import { StartPage } from './start_page';
import { text } from '../languages/text';

document.title = `Insula: ${text('exercises')}`;
const root = document.getElementById('start')!;
const base = new URL('./', window.location.href);
const page = new StartPage(root, new Api(base), () => {
  window.location.href = new URL('index.html', base).href;
});
page.load().catch((e: unknown) => {
  root.append(text('The gateway does not answer: {why}', { why: e instanceof Error ? e.message : String(e) }));
});
