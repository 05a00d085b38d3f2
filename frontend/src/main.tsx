import { render } from "preact";
import { App } from "./app/App";
import { followRoute, followSession } from "./app/follow";
import { watchKeys } from "./app/keys";
import { report } from "./commands/send";
import { t } from "./i18n";
import { watchAlerts } from "./panels/alertSounds";
import { localProblem } from "./sources/problem";
import { overlay } from "./state/overlay";
import { applySettings } from "./state/settings";
import "./style.css";

/** The example needs this long until there is something to show. */
const TOUR_AFTER_MS = 4000;

applySettings((wanted) =>
  report(
    "bar",
    localProblem(t("settings.languageLost", { language: t(`settings.language.${wanted}`) }), t("settings.languageLost.detail")),
  ),
);
watchKeys();
watchAlerts();
render(<App />, document.getElementById("app")!);
if (new URLSearchParams(location.search).has("tour")) setTimeout(() => (overlay.value = "tour"), TOUR_AFTER_MS);
/** After the safety bar and the flight's own data, which go first over a thin link. */
const KEEP_AFTER_MS = 5000;
if (import.meta.env.PROD && "serviceWorker" in navigator) {
  // where a browser allows none (plain http to another machine) the page works all the same
  setTimeout(() => navigator.serviceWorker.register("./sw.js").catch(() => undefined), KEEP_AFTER_MS);
}
// bearings that a phone took while it had no link go out whatever page it shows next; the page of bearings sends its own
setTimeout(() => {
  import("./commands/reportBearings").then(
    ({ keepSending }) => keepSending(),
    () => undefined,
  );
}, KEEP_AFTER_MS);
followSession();
followRoute();
