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
followSession();
followRoute();
