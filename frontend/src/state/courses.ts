// Courses of missions and their variants on one axis: time since the start against the expected error.
import type { CoursePoint, MissionCourses } from "../sources/coursesApi";
import { emitterName } from "./emitterName";

export interface Line {
  key: string;
  missionId: string;
  mission: string;
  /** null: as it was flown. */
  variant: string | null;
  /** That it is about; null where the mission has one only. */
  emitter: string | null;
  points: readonly CoursePoint[];
}

export const linesOf = (missions: readonly MissionCourses[]): Line[] =>
  missions.flatMap((one) =>
    one.courses.map(({ name, points }) => ({
      key: `${one.mission_id}/${name ?? ""}`,
      missionId: one.mission_id,
      mission: one.name,
      variant: name,
      emitter: one.emitters.length > 1 ? emitterName(one.emitters, one.emitter_id) : null,
      points,
    })),
  );

/** Of an axis of time from 0 to `seconds`: the step between its whole minutes, so that there are at most eight. */
export function minuteStep(seconds: number): number {
  return [1, 2, 5, 10, 20, 30, 60, 120].find((step) => seconds / 60 / step <= 8) ?? 240;
}

export const lastSecond = (missions: readonly MissionCourses[]): number =>
  Math.max(60, ...missions.flatMap((m) => [m.ended_s ?? 0, ...m.bearings_s, ...m.courses.flatMap((c) => c.points.map((p) => p.t_s))]));

/** Powers of ten times 1, 2, 5 around all expected errors, m: the axis is logarithmic. */
export function errorTicks(lines: readonly Line[]): number[] {
  const known = lines.flatMap((l) => l.points.map((p) => p.expected_rmse_m)).filter((v) => v !== null && v > 0) as number[];
  if (known.length === 0) return [1, 10, 100];
  const all = [-1, 0, 1, 2, 3, 4].flatMap((power) => [1, 2, 5].map((n) => n * 10 ** power));
  const low = all.findLast((v) => v <= Math.min(...known)) ?? all[0]!;
  const high = all.find((v) => v >= Math.max(...known)) ?? all.at(-1)!;
  return all.filter((v) => v >= low && v <= high);
}

/** A value holds until the next: an SVG path of steps over width x height. Points without an estimate interrupt it. */
export function stepPath(points: readonly CoursePoint[], x: (t: number) => number, y: (m: number) => number, until: number): string {
  let path = "";
  let open = false;
  points.forEach((point, i) => {
    const end = points[i + 1]?.t_s ?? until;
    if (point.expected_rmse_m === null) {
      open = false;
      return;
    }
    const height = y(point.expected_rmse_m).toFixed(1);
    path += `${open ? "V" : `M${x(point.t_s).toFixed(1)} `}${height}H${x(end).toFixed(1)}`;
    open = true;
  });
  return path;
}
