import { launch } from './browser.mjs';
const [,, url, out, keys] = process.argv;
const b = await launch(); const p = await b.newPage({ viewport: { width: 1280, height: 800 } });
await p.goto(url); await p.waitForFunction(() => window.__replay?.ready, null, { timeout: 60000 });
for (const k of (keys ?? '').split(',').filter(Boolean)) await p.keyboard.press(k);
await p.evaluate(() => document.querySelector('.transport input[type=checkbox]').click());
await p.waitForTimeout(4000); await p.screenshot({ path: out, timeout: 60000 }); console.log(JSON.stringify(await p.evaluate(() => window.__replay))); await b.close();
