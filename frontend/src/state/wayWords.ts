// Words for what was heard between places.
import { reasonText, t } from "../i18n";
import type { HeardOnTheWay } from "../wire";

export function wayWords({ place_number: number, stretches }: HeardOnTheWay): string {
  if (stretches.length === 0) return t("way.nothing", { number });
  const turned = Math.round(stretches.reduce((sum, stretch) => sum + stretch.turned_deg, 0));
  return t("way.heard", { number, count: stretches.length, turned });
}

export const whyLeftOut = ({ left_out }: HeardOnTheWay): string[] => left_out.map(reasonText);

/** What the nose did meanwhile; nothing where it did not swing. */
export const noseWords = ({ nose }: HeardOnTheWay): string[] => nose.map(reasonText);
