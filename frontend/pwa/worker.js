// Keeps the built page of one version, so that it opens without a link (decision 35). FILES and VERSION are written by the
// build (pwa/plugin.ts). Whatever is no file of the page is left to the browser: answers and commands of the API are
// neither seen nor kept here.
const FILES = __FILES__;
const CACHE = "crossfix-page-__VERSION__";
const KEPT_VERSIONS = 2;

const root = new URL("./", self.location);
const paths = new Set(FILES.map((file) => new URL(file, root).pathname));
const isPage = (request, url) =>
  request.mode === "navigate" && (url.pathname === root.pathname || url.pathname === `${root.pathname}index.html`);

self.addEventListener("install", (event) => {
  // "reload": not what the browser's own cache holds of the version before
  const whole = caches.open(CACHE).then((cache) => cache.addAll(FILES.map((file) => new Request(file, { cache: "reload" }))));
  event.waitUntil(whole.then(() => self.skipWaiting()));
});

self.addEventListener("activate", (event) => {
  // a page that is still open asks for files of the version before
  const old = caches.keys().then((names) => names.filter((name) => name.startsWith("crossfix-page-")).slice(0, -KEPT_VERSIONS));
  event.waitUntil(old.then((names) => Promise.all(names.map((name) => caches.delete(name)))).then(() => self.clients.claim()));
});

async function kept(request) {
  return (await caches.open(CACHE).then((cache) => cache.match(request))) ?? caches.match(request);
}

/** The server's own file, the kept one when there is no link: a new version is there with the next load. */
async function newest(request, named) {
  try {
    const answer = await fetch(request);
    if (answer.status < 500) return answer;
    return (await kept(named)) ?? answer;
  } catch (error) {
    const found = await kept(named);
    if (found) return found;
    throw error;
  }
}

self.addEventListener("fetch", (event) => {
  const { request } = event;
  const url = new URL(request.url);
  if (request.method !== "GET" || url.origin !== root.origin) return;
  if (isPage(request, url)) event.respondWith(newest(request, new URL("index.html", root).href));
  else if (url.pathname.startsWith(`${root.pathname}assets/`)) event.respondWith(kept(request).then((found) => found ?? fetch(request)));
  else if (paths.has(url.pathname)) event.respondWith(newest(request, request));
});
