import { render } from "preact";
import { App } from "./app/App";
import { followRoute } from "./app/follow";
import { watchKeys } from "./app/keys";
import { overlay } from "./app/overlay";
import { applySettings } from "./app/settings";
import { isFixture, prepareFixture } from "./app/sourceFor";
import { watchAlerts } from "./panels/alertSounds";
import "./style.css";

/** The example needs this long until there is something to show. */
const TOUR_AFTER_MS = 4000;

/** No top-level await: the pages import from this file and would wait for it for ever. */
async function start(): Promise<void> {
  applySettings();
  watchKeys();
  watchAlerts();
  if (isFixture) await prepareFixture();
  render(<App />, document.getElementById("app")!);
  if (new URLSearchParams(location.search).has("tour")) setTimeout(() => (overlay.value = "tour"), TOUR_AFTER_MS);
  followRoute();
}

void start();
