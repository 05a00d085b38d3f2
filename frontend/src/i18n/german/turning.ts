// German: how far a craft turned for a sweep, and why.
import type { ReasonTable } from "../reasons";

export const turning = {
  whole_turn: {
    text: "Ganze Drehung: {because?first=bisher war noch nichts zu hören|again=die Drehung davor ergab keine Peilung|unsure=die bisherigen Peilungen widersprechen sich|wide=der Sender kann fast überall liegen|several=mehrere Sender werden abgehört|pulsed=ein gepulster Sender braucht jede Richtung|second_place=die ersten Orte dieser Suche hören in alle Richtungen}.",
    remedy: "",
  },
  sector_expected: {
    text: "Ein Sektor von {width_deg}: in ihm liegen {share_percent} der von hier erwarteten Richtungen und ein Rand.",
    remedy: "",
  },
  maximum_seen: {
    text: "Angehalten nach {turned_deg}: Das Maximum liegt {inside_deg} vom Rand, und eine andere Richtung hat eine Wahrscheinlichkeit von {elsewhere_percent}.",
    remedy: "",
  },
  whole_circle_seen: { text: "Angehalten nach dem ganzen Kreis.", remedy: "" },
  maximum_at_edge: {
    text: "Um {by_deg} weitergedreht: Das Maximum lag am {edge?beginning=Anfang|end=Ende} des Sektors.",
    remedy: "",
  },
  quality_poor: {
    text: "Um {by_deg} weitergedreht: Das Gehörte glich dem Antennendiagramm nur zu {quality:2}.",
    remedy: "",
  },
  elsewhere_possible: {
    text: "Um {by_deg} weitergedreht: Eine noch nicht gehörte Richtung hatte eine Wahrscheinlichkeit von {elsewhere_percent}.",
    remedy: "",
  },
  bearing_uncertain: {
    text: "Um {by_deg} weitergedreht: Die Peilung war noch um {sigma_deg:1} unsicher.",
    remedy: "",
  },
  turns_here: {
    text: "Es dreht hier: {because?first=Einmal werden alle Richtungen gehört, bevor es ohne Drehung weiterfliegt|told_nothing=Der Weg hierher verriet wenig über die Richtung|contradicts=Was es hörte, widerspricht dem bisher Angenommenen}.",
    remedy: "",
  },
  way_told_enough: {
    text: "Keine Drehung hier: Nach dem, was auf dem Weg hierher zu hören war, liegt der Sender {likelier:1}-mal so wahrscheinlich am geschätzten Ort wie in irgendeiner Richtung.",
    remedy: "",
  },
  never_stop_needs: {
    text:
      "Nur zu drehen, wo der Weg wenig verriet, {what?one_emitter=geht mit einem Sender: Die Nase pendelt um eine Richtung" +
      "|carrier=geht mit einem Dauerträger: Unterwegs sind von gepulsten Sendern zu wenige Pulse zu hören" +
      "|still=geht mit einem Sender, der sich nicht bewegt" +
      "|joint=braucht gemeinsam geschätzte Peilfehler" +
      "|swings=braucht das Hören unterwegs und das Pendeln der Nase" +
      "|rollouts=braucht den Planer, der Flüge simuliert}.",
    remedy:
      "{what?one_emitter=Abschalten oder nur einen Sender suchen|carrier=Abschalten" +
      "|still=Abschalten|joint=Fehler gemeinsam schätzen lassen oder abschalten" +
      "|swings=Beides einschalten oder dies abschalten" +
      "|rollouts=Diesen Planer wählen oder dies abschalten}.",
  },
  nothing_found_yet: {
    text: "Um {by_deg} weitergedreht: Das Gehörte ergab noch keine Peilung.",
    remedy: "",
  },
} satisfies Partial<ReasonTable>;
