// The ground below the next leg: how high it is flown, and what is left above the ground.
import { useEffect, useState } from "preact/hooks";
import { reasonText, t } from "../i18n";
import { type Profile, profile } from "../sources/terrainApi";
import { settings } from "../state/settings";
import { formatLength } from "../units/quantities";
import type { Place } from "../wire";

/** Paths over 100 x 100, y downwards: the ground as an area, the clearance above it and the way as lines. */
export function profilePaths({ distance_m, ground_m, altitude_amsl_m, minimum_clearance_m }: Profile) {
  const known = ground_m.filter((height) => height !== null);
  const low = Math.min(...known, altitude_amsl_m) - 10;
  const high = Math.max(...known.map((height) => height + minimum_clearance_m), altitude_amsl_m) + 10;
  const length = Math.max(distance_m.at(-1) ?? 0, 1);
  const x = (i: number) => ((100 * distance_m[i]!) / length).toFixed(1);
  const y = (height: number) => (100 - (100 * (height - low)) / (high - low)).toFixed(1);
  const line = (above: number) => {
    let drawing = false;
    return ground_m
      .map((height, i) => {
        const command = drawing ? "L" : "M";
        drawing = height !== null;
        return height === null ? "" : `${command}${x(i)} ${y(height + above)}`;
      })
      .join("");
  };
  const ground = known.length === ground_m.length ? `${line(0)}V100H0Z` : line(0);
  return { ground, clearance: line(minimum_clearance_m), way: `M0 ${y(altitude_amsl_m)}H100` };
}

export function ProfileCard({ missionId, place }: { missionId: string; place: Place }) {
  const [found, setFound] = useState<Profile | null>(null);
  const { lat, lon } = place;
  useEffect(() => {
    let wanted = true;
    setFound(null);
    profile(missionId, { lat, lon }).then(
      (answer) => wanted && setFound(answer),
      () => undefined,
    );
    return () => {
      wanted = false;
    };
  }, [missionId, lat, lon]);
  if (!found) return null;
  if (!found.known)
    return (
      <p class="muted" data-testid="profile">
        {t("profile.none")}
      </p>
    );
  const units = settings.value.units;
  const left = found.highest_m === null ? null : found.altitude_amsl_m - found.highest_m;
  const words = t(left === null ? "profile.unknown" : "profile.words", {
    altitude: formatLength(found.altitude_amsl_m - found.home_amsl_m, units),
    left: formatLength(left ?? 0, units),
    least: formatLength(found.minimum_clearance_m, units),
  });
  const paths = profilePaths(found);
  return (
    <figure class="profile" data-testid="profile">
      <svg viewBox="0 0 100 100" preserveAspectRatio="none" role="img" aria-label={words}>
        <path class="profile-ground" d={paths.ground} />
        <path class="profile-clearance" d={paths.clearance} />
        <path class="profile-way" d={paths.way} />
      </svg>
      <figcaption>{words}</figcaption>
      {found.objections.slice(0, 1).map((reason) => (
        <p class="refused" key={reason.code}>
          {reasonText(reason)}
        </p>
      ))}
    </figure>
  );
}
