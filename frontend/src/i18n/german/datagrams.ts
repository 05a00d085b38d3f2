// German: what comes by UDP and is not taken.
import type { ReasonTable } from "../reasons";

export const datagrams = {
  datagram_too_long: { text: "Es hat {size} Byte; höchstens {most} sind erlaubt.", remedy: "Die rohen Richtungen weglassen." },
  datagram_no_bearing: {
    text: 'Es ist {what?json=kein JSON|bearing=kein Objekt vom Typ "BEARING"}.',
    remedy: "Eine Peilung je Datagramm senden, und an diesen Port nichts anderes.",
  },
  datagram_not_absolute: {
    text: 'Sein bearing_type ist nicht "absolute".',
    remedy: "Die Peilung von rechtweisend Nord senden, und den Ort.",
  },
  datagram_value_unreadable: {
    text: "{name} ist {wanted?number=keine Zahl|text=kein Text|emitter=kein Kennzeichen eines Senders}.",
    remedy: "Das sendende Programm berichtigen.",
  },
  datagram_value_impossible: {
    text: "{name} ist {value}; erlaubt ist {least} bis {most}.",
    remedy: "Das sendende Programm berichtigen.",
  },
  sender_too_busy: { text: "Von dort kommen zu viele.", remedy: "Höchstens fünf je Sekunde senden." },
  too_many_wait: { text: "Zu viele warten darauf, angenommen zu werden.", remedy: "Die Stationen seltener senden lassen." },
  same_errors_again: {
    text: "Vom selben Ort wurde von {station} vor weniger als {within_s} schon eine angenommen; sie hat dieselben Fehler.",
    remedy: "",
  },
  no_search_flies: { text: "Keine Suche fliegt.", remedy: "Eine starten; Peilungen für einen Entwurf werden über HTTP gesendet." },
} satisfies Partial<ReasonTable>;
