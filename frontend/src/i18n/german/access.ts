// German: who is let in, and who may do what.
import type { ReasonTable } from "../reasons";

export const access = {
  sign_in_needed: ["Hier ist niemand angemeldet, oder die Sitzung ist beendet.", "Melden Sie sich an."],
  first_admin_needed: [
    "Dieser Server kennt noch keine Personen und tut darum für niemanden etwas.",
    "Seine Seite öffnen und mit dem Code, den der Server beim Start ausgegeben hat, den ersten Verwalter anlegen.",
  ],
  first_admin_exists: [
    "Den ersten Verwalter gibt es schon; der Code gilt nur einmal.",
    "Melden Sie sich an, oder bitten Sie einen Verwalter um eine Einladung.",
  ],
  no_people_here: [
    "Dieser Server ist nur auf diesem Rechner zu erreichen und hat keine Konten.",
    "Um andere einzulassen, ihn mit --users starten oder mit --host und einer Adresse dieses Rechners.",
  ],
  behind_proxy: [
    "Die Anfrage kam über einen Proxy, und dieser Server hat keine Konten.",
    "Ihn mit --users starten und den Proxy in CROSSFIX_TRUSTED_PROXIES nennen.",
  ],
  role_too_low: [
    "Das darf nur {needed?viewer=wer angemeldet ist|operator=ein Operator|pilot=ein Pilot|admin=ein Verwalter}, nicht {role?viewer=ein Zuschauer|operator=ein Operator|pilot=ein Pilot|none=das Token einer Maschine}.",
    "Bitten Sie einen Verwalter um eine andere Rolle.",
  ],
  call_not_listed: ["Diesen Aufruf darf niemand: Er fehlt in der Tabelle der Berechtigungen.", "Bitte melden; das ist ein Fehler von uns."],
  origin_missing: [
    "Eine angemeldete Seite muss sagen, woher sie kommt; diese Anfrage tat es nicht.",
    "Die Seite benutzen, die dieser Server ausliefert; Programme benutzen das Token einer Maschine.",
  ],
  not_encrypted: [
    "Die Verbindung ist nicht verschlüsselt: Andere im Netz könnten das Passwort lesen.",
    "Die Seite mit https:// über den Proxy öffnen. In einem Netz, das selbst verschlüsselt, CROSSFIX_PLAIN_HTTP setzen.",
  ],
  wrong_name_or_password: ["Name oder Passwort ist falsch.", "Noch einmal versuchen, oder einen Verwalter um eine Einladung bitten."],
  no_password_here: ["Dieses Konto hat hier kein Passwort: Es meldet sich über den Anmeldedienst an.", "Das Passwort dort ändern."],
  no_provider: ["Dieser Server hat keinen Anmeldedienst.", "Mit Name und Passwort anmelden, oder CROSSFIX_OIDC_ISSUER setzen."],
  provider_refused: [
    "{fault?return=Dieser Rückweg vom Anmeldedienst wurde schon benutzt, hat länger als zehn Minuten gedauert oder begann in einem anderen Browser|" +
      "refused=Der Anmeldedienst hat Sie nicht angemeldet|away=Der Anmeldedienst antwortet nicht|" +
      "answer=Die Antwort des Anmeldedienstes war nicht annehmbar|clock=Anmeldedienst und Server sind sich über die Uhrzeit uneins|" +
      "email=Ihre E-Mail-Adresse ist nicht bestätigt, oder ihre Domäne darf nicht herein|" +
      "role=Der Anmeldedienst gibt Ihnen hier keine Rolle|shut_out=Ein Verwalter hat dieses Konto ausgesperrt}.",
    "{fault?return=Auf dieser Seite neu beginnen.|refused=Noch einmal versuchen, oder den Betreiber des Anmeldedienstes fragen.|" +
      "away=Später noch einmal versuchen, oder mit einem Passwort anmelden.|" +
      "answer=Den Betreiber dieses Servers fragen: In dessen Protokoll steht, was falsch war.|clock=Die Uhr dieses Servers stellen.|" +
      "email=Den Betreiber des Anmeldedienstes oder dieses Servers fragen.|" +
      "role=Den Betreiber des Anmeldedienstes um eine Gruppe bitten, die dieser Server kennt.|shut_out=Einen Verwalter fragen.}",
  ],
  too_many_tries: ["Das waren zu viele Versuche.", "In {wait_s} noch einmal versuchen."],
  code_unusable: [
    "Dieser Code {fault?unknown=ist nicht bekannt|used=wurde schon benutzt; jeder gilt nur einmal|expired=ist abgelaufen}.",
    "{fault?unknown=Sehen Sie nach, ob er vollständig übernommen wurde.|*=Bitten Sie um einen neuen.}",
  ],
  name_taken: ["Hier heißt schon jemand {name}.", "Einen anderen Namen wählen."],
  password_weak: [
    "Das Passwort {fault?short=ist zu kurz|simple=hat zu wenige verschiedene Zeichen|name=enthält den Namen}.",
    "Mindestens {least} Zeichen nehmen; am besten ein paar Wörter, die nur Sie so zusammenstellen.",
  ],
  last_admin: ["Das ist der letzte Verwalter.", "Zuerst jemand anderen zum Verwalter machen."],
  command_id_reused: [
    "Diese Befehlsnummer gehört schon zu einem anderen Befehl („{command}“); nichts wurde getan.",
    "Jeden Befehl mit einer eigenen Nummer senden.",
  ],
  control_free: ["Niemand steuert diese Suche.", "Übernehmen Sie zuerst die Steuerung."],
  control_held: [
    "{name} steuert diese Suche.",
    "Bitten Sie um die Steuerung; ein Pilot kann sie sofort übernehmen. Halten und Abbrechen gehen immer.",
  ],
  control_stale: [
    "Dieser Befehl wurde gegeben, bevor die Steuerung wechselte; nichts wurde getan.",
    "Sehen Sie nach, was jetzt gilt, und befehlen Sie dann neu.",
  ],
  control_asked_already: ["{name} hat schon um die Steuerung gebeten.", "Warten Sie auf die Antwort."],
  control_not_asked: ["Niemand bittet um die Steuerung."],
  control_not_yours: ["Sie steuern diese Suche nicht."],
  control_needless: ["Dieser Server hat keine Konten: Wer vor ihm sitzt, steuert jede Suche."],
} satisfies Partial<ReasonTable>;
