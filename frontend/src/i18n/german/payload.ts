// German: the payload, its receiver, its link and its configuration.
import type { ReasonTable } from "../reasons";

export const payload = {
  payload_starting: { text: "Die Nutzlast öffnet ihren Empfänger.", remedy: "" },
  payload_listening: { text: "Die Nutzlast hört auf {channels|Sender|Sender}.", remedy: "" },
  payload_state_unknown: {
    text: "Der Empfänger der Nutzlast ist in einem Zustand, den dieser Server nicht kennt („{told}“).",
    remedy: "Den Server aktualisieren.",
  },
  no_payload_connected: {
    text: "Keine Nutzlast ist verbunden.",
    remedy: "Prüfen, ob ihr Agent läuft (crossfix payload), ebenso ihre Verbindung und ihr Token.",
  },
  payload_away: { text: "Seit {away_s} ist keine Nutzlast verbunden.", remedy: "Ihren Strom und ihre Verbindung prüfen." },
  payload_tokens_missing: {
    text: "Als Empfänger ist der einer Nutzlast gewählt, aber keine Nutzlast darf sich verbinden.",
    remedy: "Dem Server in CROSSFIX_PAYLOAD_TOKENS die Tokens seiner Nutzlasten geben.",
  },
  spool_unusable: {
    text: "Die Warteschlange {path} der Nutzlast ist nicht verwendbar ({detail}).",
    remedy: "Prüfen, ob die Platte beschreibbar ist, oder ein anderes Verzeichnis nennen.",
  },
  spool_not_written: {
    text: "Die Warteschlange der Nutzlast ist nicht beschreibbar ({detail}).",
    remedy: "Prüfen, ob ihre Platte voll ist.",
  },
  other_protocol: {
    text: "Die Nutzlast spricht Version {theirs} des Protokolls, der Server Version {ours}.",
    remedy: "{older?payload=Die Software der Nutzlast|server=Den Server} aktualisieren.",
  },
  message_out_of_turn: {
    text: "{wrong?no_hello=Die Nutzlast hat sich nicht zuerst gemeldet|second_hello=Die Nutzlast hat sich zweimal gemeldet|no_welcome=Der Server hat die Nutzlast nicht begrüßt}.",
    remedy: "Prüfen, ob auf beiden Crossfix läuft; wenn ja, es melden.",
  },
  message_not_understood: {
    text: "Eine Nachricht war nicht zu verstehen ({place}: {problem}).",
    remedy: "Die Software der Nutzlast und den Server aktualisieren.",
  },
  payload_connected_again: {
    text: "Die Nutzlast „{name}“ hat sich noch einmal verbunden; damit endet die ältere Verbindung.",
    remedy: "Sind es zwei, einer davon einen anderen Namen geben.",
  },
  refused_by_server: { text: "Der Server schloss die Verbindung mit den Worten „{says}“.", remedy: "" },
  configuration_unreadable: {
    text: "Die Konfiguration {path} ist keine lesbare TOML-Datei ({detail}).",
    remedy: "Sie berichtigen oder mit --save neu schreiben.",
  },
  configuration_entry_missing: {
    text: "In der Konfiguration fehlt der Eintrag „{entry}“.",
    remedy: "--{option} angeben oder ihn in die Datei schreiben.",
  },
  configuration_entry_wrong: {
    text: "Der Eintrag „{entry}“ der Konfiguration ist falsch ({problem}).",
    remedy: "Ihn berichtigen.",
  },
  pulse_timing_incomplete: {
    text: "Ein pulsender Sender braucht die Breite seiner Pulse und ihre Periode.",
    remedy: "Für einen pulsenden Sender --pulse-width-s und --pulse-period-s angeben, für einen Träger keines von beiden.",
  },
} satisfies Partial<ReasonTable>;
