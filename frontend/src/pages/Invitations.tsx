// Letting people in: a link and its QR code, each for one person, shown once.
import { useEffect, useRef, useState } from "preact/hooks";
import { t } from "../i18n";
import * as access from "../sources/accessApi";
import { COUNTS, phonesNext } from "../state/invite";
import type { Try } from "./PeoplePage";
import { RolePick } from "./RolePick";

const HOURS = [1, 24, 168] as const;

function Made({ made }: { made: access.MadeInvitation }) {
  return (
    <div class="card made-invitation" data-testid="made-invitation">
      <img src={made.qr} alt={t("people.qr")} width={240} height={240} />
      <div>
        <p>{t("people.qr.explain", { role: t(`role.${made.invitation.role}`) })}</p>
        <input
          readOnly
          value={made.link}
          aria-label={t("people.link")}
          data-testid="invitation-link"
          onFocus={(e) => e.currentTarget.select()}
        />
      </div>
    </div>
  );
}

interface Properties {
  list: access.Invitation[];
  sending: boolean;
  attempt: Try;
}

export function Invitations({ list, sending, attempt }: Properties) {
  const [role, setRole] = useState<access.Role>("operator");
  const [admin, setAdmin] = useState(false);
  const [hours, setHours] = useState<number>(24);
  const [count, setCount] = useState<number>(phonesNext.peek() || 1);
  const [made, setMade] = useState<access.MadeInvitation[]>([]);
  const makeAll = async () => {
    setMade([]);
    for (let k = 0; k < count; k++) {
      const one = await access.invite(role, admin, hours);
      setMade((before) => [...before, one]);
    }
  };
  useEffect(() => {
    if (phonesNext.peek() === 0) return;
    phonesNext.value = 0;
    attempt(makeAll());
  }, []);
  const shown = useRef<HTMLDivElement>(null);
  useEffect(() => shown.current?.scrollIntoView({ block: "nearest" }), [made.length]);
  /** Back to one: two links for the next person, one of them for nobody, would be easily overlooked. */
  const done = () => {
    setMade([]);
    setCount(1);
  };
  const takeBack = async (id: string) => {
    await access.takeBackInvitation(id);
    setMade((before) => before.filter((other) => other.invitation.invitation_id !== id));
  };
  return (
    <section>
      <div class="page-head">
        <h1>{t("people.invite")}</h1>
      </div>
      <div class="card person">
        <div class="person-acts">
          <RolePick value={role} label={t("people.role")} onPick={setRole} />
          <select aria-label={t("people.count")} value={String(count)} onChange={(e) => setCount(Number(e.currentTarget.value))}>
            {COUNTS.map((each) => (
              <option value={String(each)} key={each}>
                {t("people.forPhones", { count: each })}
              </option>
            ))}
          </select>
          <select aria-label={t("people.lasts")} value={String(hours)} onChange={(e) => setHours(Number(e.currentTarget.value))}>
            {HOURS.map((each) => (
              <option value={String(each)} key={each}>
                {t("people.lastsFor", { time: t(`people.hours.${each}`) })}
              </option>
            ))}
          </select>
          <label class="check">
            <input type="checkbox" checked={admin} onChange={(e) => setAdmin(e.currentTarget.checked)} />
            {t("people.admin")}
          </label>
          <button type="button" class="primary" data-testid="invite" disabled={sending} onClick={() => attempt(makeAll())}>
            {t("people.invite.submit")}
          </button>
        </div>
      </div>
      {made.length > 0 && (
        <>
          <div class="made-invitations" ref={shown}>
            {made.map((one) => (
              <Made made={one} key={one.invitation.invitation_id} />
            ))}
          </div>
          <button type="button" class="invitations-done" onClick={done}>
            {t("people.qr.done")}
          </button>
        </>
      )}
      <ul class="cards">
        {list.map((one) => (
          <li class="card person" key={one.invitation_id} data-testid="invitation">
            <span>
              {t(`role.${one.role}`)} {one.admin && `+ ${t("people.admin")}`}{" "}
              <span class="muted">
                {t("people.invitedBy", {
                  name: one.made_by,
                  time: `${one.expires_utc.slice(0, 16).replace("T", " ")} UTC`,
                })}
              </span>
            </span>
            <button type="button" onClick={() => attempt(takeBack(one.invitation_id))}>
              {t("people.takeBack")}
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}
