// An invitation by link or QR code: what it offers, and the account that it makes.
import { useEffect, useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { firstPlace } from "../commands/suggested";
import { t } from "../i18n";
import { ProblemBox } from "../panels/ProblemNote";
import { acceptInvitation, type InvitationOffer, lookAtInvitation } from "../sources/accessApi";
import { go } from "../state/route";
import { session } from "../state/session";
import type { Problem } from "../wire";
import { EntryForm } from "./EntryForm";

export function JoinPage({ route }: { route: { code: string } }) {
  const [offer, setOffer] = useState<InvitationOffer | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  useEffect(() => {
    lookAtInvitation(route.code).then(setOffer, (error: unknown) => setProblem(asProblem(error)));
  }, [route.code]);
  return (
    <div class="page entry-page" data-testid="join-page">
      {problem && (
        <div class="card entry">
          <ProblemBox problem={problem} />
          <a class="button" href="#/">
            {t("entry.signIn")}
          </a>
        </div>
      )}
      {offer && (
        <EntryForm
          title={t("entry.join")}
          submit={t("entry.join.submit")}
          fresh
          onSubmit={async (name, password) => {
            const entered = await acceptInvitation(route.code, name, password);
            const place = await firstPlace(offer.role !== "viewer");
            session.value = entered;
            go(place);
          }}
        >
          <p data-testid="join-role">
            {t("entry.join.explain", { role: t(`role.${offer.role}`) })} {offer.admin && t("entry.join.admin")}
          </p>
        </EntryForm>
      )}
    </div>
  );
}
