// German: what comes by UDP and is not taken.
import type { ReasonTable } from "../reasons";

export const datagrams = {
  datagram_too_long: ["Es hat {size} Byte; höchstens {most} sind erlaubt.", "Die rohen Richtungen weglassen."],
  datagram_no_bearing: [
    'Es ist {what?json=kein JSON|bearing=kein Objekt vom Typ "BEARING"}.',
    "Eine Peilung je Datagramm senden, und an diesen Port nichts anderes.",
  ],
  datagram_not_absolute: ['Sein bearing_type ist nicht "absolute".', "Die Peilung von rechtweisend Nord senden, und den Ort."],
  datagram_value_unreadable: [
    "{name} ist {wanted?number=keine Zahl|text=kein Text|emitter=kein Kennzeichen eines Senders}.",
    "Das sendende Programm berichtigen.",
  ],
  datagram_value_impossible: ["{name} ist {value}; erlaubt ist {least} bis {most}.", "Das sendende Programm berichtigen."],
  sender_too_busy: ["Von dort kommen zu viele.", "Höchstens fünf je Sekunde senden."],
  too_many_wait: ["Zu viele warten darauf, angenommen zu werden.", "Die Stationen seltener senden lassen."],
  same_errors_again: ["Vom selben Ort wurde von {station} vor weniger als {within_s} schon eine angenommen; sie hat dieselben Fehler."],
  no_search_flies: ["Keine Suche fliegt.", "Eine starten; Peilungen für einen Entwurf werden über HTTP gesendet."],
} satisfies Partial<ReasonTable>;
