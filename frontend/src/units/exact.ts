import { formatNumber } from "./quantities";

/** With as many decimals as it has, four at most. */
export function formatExact(value: number): string {
  const [, decimals = ""] = String(Number(value.toFixed(4))).split(".");
  return formatNumber(value, decimals.length);
}
