// SPDX-License-Identifier: GPL-3.0-or-later
// The manual's search, in the page itself: it takes the place of MkDocs' own, which fetches its index and starts a worker. A page
// that was opened from a folder (file://) may do neither; scripts it may load from anywhere. `?q=WORDS` searches at once.
// Some of MkDocs' templates load this script before the search's own elements.
function offerSearch() {
  'use strict';
  const input = document.getElementById('mkdocs-search-query');
  const list = document.getElementById('mkdocs-search-results');
  if (!input || !list) return;
  const most = 40;

  function load(path) {
    return new Promise((done, failed) => {
      const script = document.createElement('script');
      script.src = base_url.replace(/\/?$/, '/') + path;
      script.onload = done;
      script.onerror = () => failed(new Error(path + ' is missing'));
      document.head.append(script);
    });
  }

  // Made when the first word is typed: half a second on a page that may never be searched from.
  let made = null;
  function index() {
    made ??= load('search/lunr.js').then(() => load('search/index.js')).then(() => {
      const places = new Map(window.manual_index.docs.map((d) => [d.location, d]));
      const words = lunr(function () {
        this.ref('location');
        this.field('title', { boost: 4 });
        this.field('text');
        for (const d of places.values()) this.add(d);
      });
      return { places, words };
    });
    return made;
  }

  function line(text) {
    const p = document.createElement('p');
    p.textContent = text;
    return p;
  }

  function article(place) {
    const link = document.createElement('a'), heading = document.createElement('h3'), out = document.createElement('article');
    link.href = base_url.replace(/\/?$/, '/') + place.location;
    link.textContent = place.title;
    heading.append(link);
    out.append(heading, line(place.text.slice(0, 200)));
    return out;
  }

  // Whole words count, and the last one as a beginning too, since it is still being typed. Signs of lunr's own language are words here.
  function found({ words }, text) {
    const terms = text.toLowerCase().split(/[\s\-]+/).map((t) => t.replace(/^[^\p{L}\p{N}_]+|[^\p{L}\p{N}_]+$/gu, '')).filter((t) => t !== '');
    return words.query((q) => {
      for (const t of terms) q.term(lunr.tokenizer(t), { presence: lunr.Query.presence.OPTIONAL, boost: 10 });
      if (terms.length > 0) q.term(terms[terms.length - 1], { wildcard: lunr.Query.wildcard.TRAILING, usePipeline: false });
    });
  }

  let asked = 0;
  async function search() {
    const text = input.value.trim(), mine = ++asked;
    if (text.length < 2) return list.replaceChildren();
    try {
      const all = await index();
      if (mine !== asked) return;
      const results = found(all, text);
      list.replaceChildren(...(results.length === 0 ? [line(list.dataset.noResultsText || 'No results found')] : results.slice(0, most).map((r) => article(all.places.get(r.ref)))));
    } catch (error) {
      list.replaceChildren(line('The search does not work: ' + error.message));
    }
  }

  input.addEventListener('input', search);
  const words = new URLSearchParams(window.location.search).get('q');
  if (words) {
    input.value = words;
    search();
  }
}
if (document.readyState === 'loading') document.addEventListener('DOMContentLoaded', offerSearch);
else offerSearch();
