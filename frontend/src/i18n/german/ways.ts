// German: roads, paths and barriers, and where no way leads.
import type { ReasonTable } from "../reasons";

export const ways = {
  neither_way_nor_barrier: ["{parts|Teil blieb|Teile blieben} weg: Nichts sagt, ob es eine Straße, ein Pfad oder ein Hindernis ist."],
  far_from_search: ["{parts|Teil blieb|Teile blieben} weg, weiter als {most_m} vom Suchgebiet."],
  no_ways_in_file: [
    "In der Datei ist keine Straße, kein Pfad und kein Hindernis zu erkennen; {parts|anderer Teil ist|andere Teile sind} darin.",
    "Jeder Linie oder Fläche eine Eigenschaft „kind“ geben, die „road“, „path“ oder „barrier“ ist, oder sie mit ihren Tags aus OpenStreetMap ausgeben.",
  ],
  ways_too_far: [
    "Keine Straße, kein Pfad und kein Hindernis der Datei liegt näher als {most_m} am Suchgebiet; am nächsten liegt, was {nearest_m} entfernt ist.",
    "Die Datei zu dieser Suche nehmen. In GeoJSON steht die Länge vor der Breite.",
  ],
  ways_too_many: [
    "Die Straßen, Pfade und Hindernisse um das Suchgebiet haben {positions} Positionen; mehr als {most} dürfen es nicht sein.",
    "Die Datei auf die Suche und die Wege dorthin zuschneiden oder Unnötiges weglassen.",
  ],
  no_road_near: [
    "Von Ihrem Ort führt keine Straße weg: Die nächste bekannte ist {nearest_m} entfernt, und das Auto wird bis {most_m} gesucht, auf Ihrer Seite der Hindernisse.",
    "Angeben, wo das Auto steht, zu Fuß gehen oder Wege mit der fehlenden Straße hochladen.",
  ],
  no_way_leads_there: [
    "Dorthin führt kein Weg: {places|Ort|Orte} zum Hören, und keiner ist von Ihrem Ort aus {on_roads?true=auf bekannten Straßen|false=ohne Überqueren von Hindernissen} zu erreichen.",
    "Anderswo beginnen oder Wege mit der fehlenden Straße, Brücke oder Pforte hochladen.",
  ],
} satisfies Partial<ReasonTable>;
