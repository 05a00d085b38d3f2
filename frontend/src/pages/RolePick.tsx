// One of the roles, from the least to the most.
import { t } from "../i18n";
import type { Role } from "../sources/accessApi";

const ROLES: readonly Role[] = ["viewer", "operator", "pilot"];

export function RolePick({ value, label, onPick }: { value: Role; label: string; onPick: (role: Role) => void }) {
  return (
    <select aria-label={label} data-testid="role" value={value} onChange={(e) => onPick(e.currentTarget.value as Role)}>
      {ROLES.map((role) => (
        <option value={role} key={role}>
          {t(`role.${role}`)}
        </option>
      ))}
    </select>
  );
}
