// German: the payload, its receiver, its link and its configuration.
import type { ReasonTable } from "../reasons";

export const payload = {
  payload_starting: ["Die Nutzlast öffnet ihren Empfänger."],
  payload_listening: ["Die Nutzlast hört auf {channels|Sender|Sender}."],
  payload_state_unknown: [
    "Der Empfänger der Nutzlast ist in einem Zustand, den dieser Server nicht kennt („{told}“).",
    "Den Server aktualisieren.",
  ],
  no_payload_connected: [
    "Keine Nutzlast ist verbunden.",
    "Prüfen, ob ihr Agent läuft (crossfix payload), ebenso ihre Verbindung und ihr Token.",
  ],
  payload_away: ["Seit {away_s} ist keine Nutzlast verbunden.", "Ihren Strom und ihre Verbindung prüfen."],
  payload_tokens_missing: [
    "Als Empfänger ist der einer Nutzlast gewählt, aber keine Nutzlast darf sich verbinden.",
    "Dem Server in CROSSFIX_PAYLOAD_TOKENS die Tokens seiner Nutzlasten geben.",
  ],
  spool_unusable: [
    "Die Warteschlange {path} der Nutzlast ist nicht verwendbar ({detail}).",
    "Prüfen, ob die Platte beschreibbar ist, oder ein anderes Verzeichnis nennen.",
  ],
  spool_not_written: ["Die Warteschlange der Nutzlast ist nicht beschreibbar ({detail}).", "Prüfen, ob ihre Platte voll ist."],
  other_protocol: [
    "Die Nutzlast spricht Version {theirs} des Protokolls, der Server Version {ours}.",
    "{older?payload=Die Software der Nutzlast|server=Den Server} aktualisieren.",
  ],
  message_out_of_turn: [
    "{wrong?no_hello=Die Nutzlast hat sich nicht zuerst gemeldet|second_hello=Die Nutzlast hat sich zweimal gemeldet|no_welcome=Der Server hat die Nutzlast nicht begrüßt}.",
    "Prüfen, ob auf beiden Crossfix läuft; wenn ja, es melden.",
  ],
  message_not_understood: [
    "Eine Nachricht war nicht zu verstehen ({place}: {problem}).",
    "Die Software der Nutzlast und den Server aktualisieren.",
  ],
  payload_connected_again: [
    "Die Nutzlast „{name}“ hat sich noch einmal verbunden; damit endet die ältere Verbindung.",
    "Sind es zwei, einer davon einen anderen Namen geben.",
  ],
  refused_by_server: ["Der Server schloss die Verbindung mit den Worten „{says}“."],
  configuration_unreadable: [
    "Die Konfiguration {path} ist keine lesbare TOML-Datei ({detail}).",
    "Sie berichtigen oder mit --save neu schreiben.",
  ],
  configuration_entry_missing: ["In der Konfiguration fehlt der Eintrag „{entry}“.", "--{option} angeben oder ihn in die Datei schreiben."],
  configuration_entry_wrong: ["Der Eintrag „{entry}“ der Konfiguration ist falsch ({problem}).", "Ihn berichtigen."],
  pulse_timing_incomplete: [
    "Ein pulsender Sender braucht die Breite seiner Pulse und ihre Periode.",
    "Für einen pulsenden Sender --pulse-width-s und --pulse-period-s angeben, für einen Träger keines von beiden.",
  ],
} satisfies Partial<ReasonTable>;
