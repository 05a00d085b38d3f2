import { t } from "../i18n";
import { signOut } from "../sources/accessApi";
import { flying } from "../state/flying";
import { type Overlay, overlay, toggle } from "../state/overlay";
import { bearingsAddress, route } from "../state/route";
import { me } from "../state/session";
import { Icon } from "./Icon";

const show = (which: Overlay) => () => {
  overlay.value = which;
};
const close = () => {
  overlay.value = null;
};

/** On a page without the parts it explains the tour is of the example, unless something flies: then nobody is led away. */
function showTour(): void {
  if (route.peek().page === "mission" || flying.peek()) overlay.value = "tour";
  else location.href = "?tour#/mission/example";
}

export function Menu() {
  const isOpen = overlay.value === "menu";
  const here = route.value;
  return (
    <nav class="anchor" aria-label={t("bar.menu")}>
      <button
        type="button"
        class="icon"
        data-testid="menu"
        aria-label={t("bar.menu")}
        aria-expanded={isOpen}
        onClick={() => toggle("menu")}
      >
        <Icon name="menu" />
      </button>
      {isOpen && (
        <ul class="popover menu">
          <li>
            <a href="#/" onClick={close} data-testid="menu-missions">
              {t("menu.missions")}
            </a>
          </li>
          <li>
            <a href="#/new" onClick={close} data-testid="menu-new">
              {t("menu.new")}
            </a>
          </li>
          {here.page === "mission" && here.missionId !== "example" && (
            <li>
              <a href={bearingsAddress(here.missionId)} onClick={close} data-testid="menu-report">
                {t("menu.report")}
              </a>
            </li>
          )}
          <li>
            <a href="#/maps" onClick={close} data-testid="menu-maps">
              {t("menu.maps")}
            </a>
          </li>
          <li>
            <a href="#/calibration" onClick={close} data-testid="menu-calibration">
              {t("menu.calibration")}
            </a>
          </li>
          <li>
            <a href="#/people" onClick={close} data-testid="menu-people">
              {t("menu.people")}
            </a>
          </li>
          <li>
            <a href="#/health" onClick={close} data-testid="menu-health">
              {t("menu.health")}
            </a>
          </li>
          <li>
            <button type="button" onClick={show("settings")} data-testid="menu-settings">
              {t("menu.settings")}
            </button>
          </li>
          <li>
            <button type="button" onClick={show("keys")} data-testid="menu-keys">
              {t("menu.keys")} <kbd>?</kbd>
            </button>
          </li>
          <li>
            <button type="button" onClick={showTour} data-testid="menu-tour">
              {t("menu.tour")}
            </button>
          </li>
          {me.value && (
            <li>
              <button type="button" data-testid="menu-sign-out" onClick={() => void signOut().finally(() => location.reload())}>
                {t("menu.signOut", { name: me.value.name })}
              </button>
            </li>
          )}
        </ul>
      )}
    </nav>
  );
}
