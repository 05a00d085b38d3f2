import { render } from "preact";
import { App } from "./app/App";
import { watchKeys } from "./app/keys";
import { applySettings } from "./app/settings";
import { isFixture, prepareFixture, sourceFor } from "./app/sourceFor";
import { open, source } from "./app/store";
import { watchAlerts } from "./panels/alertSounds";
import "./style.css";

applySettings();
watchKeys();
watchAlerts();
if (isFixture) await prepareFixture();
render(<App />, document.getElementById("app")!);
if (source.peek() === null) open(sourceFor(null));
