// The safety bar at once; everything else as it arrives.
import type { ComponentType } from "preact";
import { useEffect, useState } from "preact/hooks";
import { t } from "../i18n";
import { SafetyBar } from "../panels/SafetyBar";
import { followed, isGone } from "../state/gone";
import { overlay } from "../state/overlay";
import { type Route, route } from "../state/route";
import { entered } from "../state/session";
import { wearTypeface } from "./typeface";

type Page = ComponentType<Record<string, unknown>>;
type Loader = () => Promise<unknown>;

const loaders: Record<Route["page"] | "sheets", Loader> = {
  missions: () => import("../pages/MissionsPage").then((m) => m.MissionsPage),
  new: () => import("../pages/EditPage").then((m) => m.EditPage),
  edit: () => import("../pages/EditPage").then((m) => m.EditPage),
  mission: () => import("../pages/FlyPage").then((m) => m.FlyPage),
  area: () => import("../pages/AreaPage").then((m) => m.AreaPage),
  bearings: () => import("../pages/BearingsPage").then((m) => m.BearingsPage),
  maps: () => import("../pages/MapsPage").then((m) => m.MapsPage),
  health: () => import("../pages/HealthPage").then((m) => m.HealthPage),
  calibration: () => import("../pages/CalibrationPage").then((m) => m.CalibrationPage),
  report: () => import("../pages/ReportPage").then((m) => m.ReportPage),
  compare: () => import("../pages/ComparePage").then((m) => m.ComparePage),
  people: () => import("../pages/PeoplePage").then((m) => m.PeoplePage),
  join: () => import("../pages/JoinPage").then((m) => m.JoinPage),
  signIn: () => import("../pages/SignInPage").then((m) => m.SignInPage),
  firstAdmin: () => import("../pages/SignInPage").then((m) => m.SignInPage),
  sheets: () => import("../pages/Sheets").then((m) => m.Sheets),
};

function Lazy({ name, quiet = false, ...properties }: { name: keyof typeof loaders; quiet?: boolean } & Record<string, unknown>) {
  const [state, setState] = useState<{ name: string; page: Page | null; failed: boolean }>({ name: "", page: null, failed: false });
  useEffect(() => {
    let wanted = true;
    loaders[name]().then(
      (page) => {
        wearTypeface();
        if (wanted) setState({ name, page: page as Page, failed: false });
      },
      () => wanted && setState({ name, page: null, failed: true }),
    );
    return () => {
      wanted = false;
    };
  }, [name]);
  if (state.failed) {
    return (
      <div class="center" role="alert">
        <p>
          {t("app.loadFailed")}{" "}
          <button type="button" onClick={() => location.reload()}>
            {t("app.reload")}
          </button>
        </p>
      </div>
    );
  }
  const Shown = state.name === name ? state.page : null;
  if (!Shown) return quiet ? null : <p class="center muted">{t("app.loading")}</p>;
  return <Shown {...properties} />;
}

function Sheets() {
  const which = overlay.value;
  if (which !== "settings" && which !== "keys" && which !== "tour" && which !== "instruments") return null;
  return <Lazy name="sheets" quiet which={which} />;
}

function NoMission() {
  return (
    <div class="center" role="alert" data-testid="no-mission">
      <p>
        {t("app.noMission")}
        <br />
        <button type="button" onClick={() => location.reload()}>
          {t("app.reload")}
        </button>{" "}
        <a class="button" href="#/">
          {t("app.missions")}
        </a>
      </p>
    </div>
  );
}

export function App() {
  const current = route.value;
  if (entered.value === "out" || current.page === "join") {
    const name = current.page === "join" ? "join" : "signIn";
    return (
      <main>
        <Lazy name={name} route={current} key={name} />
      </main>
    );
  }
  const shown = current.page === "signIn" || current.page === "firstAdmin" ? "missions" : current.page;
  return (
    <>
      <SafetyBar />
      <main>{isGone(followed(current)) ? <NoMission /> : <Lazy name={shown} route={current} key={shown} />}</main>
      <Sheets />
    </>
  );
}
