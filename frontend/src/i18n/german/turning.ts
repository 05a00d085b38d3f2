// German: how far a craft turned for a sweep, and why.
import type { ReasonTable } from "../reasons";

export const turning = {
  whole_turn: [
    "Ganze Drehung: {because?first=bisher war noch nichts zu hören|again=die Drehung davor ergab keine Peilung|unsure=die bisherigen Peilungen widersprechen sich|wide=der Sender kann fast überall liegen|several=mehrere Sender werden abgehört|pulsed=ein gepulster Sender braucht jede Richtung|second_place=die ersten Orte dieser Suche hören in alle Richtungen}.",
  ],
  sector_expected: ["Ein Sektor von {width_deg}: in ihm liegen {share_percent} der von hier erwarteten Richtungen und ein Rand."],
  maximum_seen: [
    "Angehalten nach {turned_deg}: Das Maximum liegt {inside_deg} vom Rand, und eine andere Richtung hat eine Wahrscheinlichkeit von {elsewhere_percent}.",
  ],
  whole_circle_seen: ["Angehalten nach dem ganzen Kreis."],
  maximum_at_edge: ["Um {by_deg} weitergedreht: Das Maximum lag am {edge?beginning=Anfang|end=Ende} des Sektors."],
  quality_poor: ["Um {by_deg} weitergedreht: Das Gehörte glich dem Antennendiagramm nur zu {quality:2}."],
  elsewhere_possible: [
    "Um {by_deg} weitergedreht: Eine noch nicht gehörte Richtung hatte eine Wahrscheinlichkeit von {elsewhere_percent}.",
  ],
  bearing_uncertain: ["Um {by_deg} weitergedreht: Die Peilung war noch um {sigma_deg:1} unsicher."],
  turns_here: [
    "Es dreht hier: {because?first=Einmal werden alle Richtungen gehört, bevor es ohne Drehung weiterfliegt|told_nothing=Der Weg hierher verriet wenig über die Richtung|contradicts=Was es hörte, widerspricht dem bisher Angenommenen}.",
  ],
  way_told_enough: [
    "Keine Drehung hier: Nach dem, was auf dem Weg hierher zu hören war, liegt der Sender {likelier:1}-mal so wahrscheinlich am geschätzten Ort wie in irgendeiner Richtung.",
  ],
  never_stop_needs: [
    "Nur zu drehen, wo der Weg wenig verriet, {what?one_emitter=geht mit einem Sender: Die Nase pendelt um eine Richtung" +
      "|carrier=geht mit einem Dauerträger: Unterwegs sind von gepulsten Sendern zu wenige Pulse zu hören" +
      "|still=geht mit einem Sender, der sich nicht bewegt" +
      "|joint=braucht gemeinsam geschätzte Peilfehler" +
      "|swings=braucht das Hören unterwegs und das Pendeln der Nase" +
      "|rollouts=braucht den Planer, der Flüge simuliert}.",
    "{what?one_emitter=Abschalten oder nur einen Sender suchen|carrier=Abschalten" +
      "|still=Abschalten|joint=Fehler gemeinsam schätzen lassen oder abschalten" +
      "|swings=Beides einschalten oder dies abschalten" +
      "|rollouts=Diesen Planer wählen oder dies abschalten}.",
  ],
  nothing_found_yet: ["Um {by_deg} weitergedreht: Das Gehörte ergab noch keine Peilung."],
} satisfies Partial<ReasonTable>;
