// A small grid filter for the built-in example: enough to draw a true-to-life belief, no more.
import { destination, metresPerDegree } from "../state/geometry";
import type { EstimateFact } from "../wire";
import type { BeliefFrame, LonLat } from "../wire/beliefFrame";

const RAD = Math.PI / 180;

export class ExampleBelief {
  readonly nx = 104;
  readonly ny = 40;
  private readonly p: Float64Array;

  constructor(
    private readonly sw: LonLat,
    private readonly widthM: number,
    private readonly heightM: number,
    private readonly missionId: string,
  ) {
    this.p = new Float64Array(this.nx * this.ny).fill(1 / (this.nx * this.ny));
  }

  private centre(i: number, j: number): [number, number] {
    return [((i + 0.5) * this.widthM) / this.nx, ((j + 0.5) * this.heightM) / this.ny];
  }

  private offset(at: LonLat): [number, number] {
    const [mx, my] = metresPerDegree(this.sw[1]);
    return [(at[0] - this.sw[0]) * mx, (at[1] - this.sw[1]) * my];
  }

  toLonLat(x: number, y: number): LonLat {
    const [mx, my] = metresPerDegree(this.sw[1]);
    return [this.sw[0] + x / mx, this.sw[1] + y / my];
  }

  /** Multiply by the likelihood of a bearing taken at `at`, normalize. */
  update(at: LonLat, bearingDeg: number, sigmaDeg: number): void {
    const [sx, sy] = this.offset(at);
    let sum = 0;
    for (let j = 0; j < this.ny; j++) {
      for (let i = 0; i < this.nx; i++) {
        const [x, y] = this.centre(i, j);
        const error = ((Math.atan2(x - sx, y - sy) / RAD - bearingDeg + 540) % 360) - 180;
        const n = j * this.nx + i;
        this.p[n]! *= 0.95 * Math.exp(-0.5 * (error / sigmaDeg) ** 2) + 0.002;
        sum += this.p[n]!;
      }
    }
    for (let n = 0; n < this.p.length; n++) this.p[n]! /= sum;
  }

  estimate(): EstimateFact {
    const best = this.p.indexOf(Math.max(...this.p));
    const [x0, y0] = this.centre(best % this.nx, Math.floor(best / this.nx));
    let rmse = 0;
    let [xx, xy, yy] = [0, 0, 0];
    for (let j = 0; j < this.ny; j++) {
      for (let i = 0; i < this.nx; i++) {
        const [x, y] = this.centre(i, j);
        const w = this.p[j * this.nx + i]!;
        const [dx, dy] = [x - x0, y - y0];
        rmse += w * Math.hypot(dx, dy);
        xx += w * dx * dx;
        xy += w * dx * dy;
        yy += w * dy * dy;
      }
    }
    const middle = (xx + yy) / 2;
    const spread = Math.hypot((xx - yy) / 2, xy);
    const axis = (90 - (Math.atan2(2 * xy, xx - yy) / 2 / RAD) + 360) % 180;
    const [major, minor] = [2.45 * Math.sqrt(middle + spread), 2.45 * Math.sqrt(Math.max(1, middle - spread))];
    const place = this.toLonLat(x0, y0);
    const ring = Array.from({ length: 37 }, (_, k) => {
      const a = (k / 36) * 2 * Math.PI;
      const along = destination(place, axis, major * Math.cos(a));
      return destination(along, axis + 90, minor * Math.sin(a));
    });
    ring[36] = ring[0]!;
    return {
      lat: place[1],
      lon: place[0],
      expected_rmse_m: rmse,
      c95: { type: "Polygon", coordinates: [ring] },
      c95_area_m2: Math.PI * major * minor,
      major_axis_m: major,
      minor_axis_m: minor,
      major_axis_deg: axis,
    };
  }

  frame(bearings: number): BeliefFrame {
    const peak = Math.max(...this.p);
    return {
      missionId: this.missionId,
      bearings,
      nx: this.nx,
      ny: this.ny,
      bounds: [this.sw, this.toLonLat(this.widthM, 0), this.toLonLat(this.widthM, this.heightM), this.toLonLat(0, this.heightM)],
      peak,
      cells: Float32Array.from(this.p, (v) => v / peak),
    };
  }
}
