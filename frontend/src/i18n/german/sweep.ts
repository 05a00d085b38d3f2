// German: why a sweep gives no bearing; antenna and pattern.
import type { ReasonTable } from "../reasons";

export const sweep = {
  no_pulse_heard: {
    text: "In keiner Richtung war ein Puls des Senders zu hören.",
    remedy: "Ihn einschalten oder näher bei ihm messen.",
  },
  pulses_not_given: {
    text:
      "Auf dieser Frequenz senden mehrere: {given} Pulse sind zugeordnet; {overlapping} von zweien zugleich, {unclear}, die von " +
      "mehr als einem sein könnten, und {strangers}, die zu keinem passen, zählen für keinen.",
    remedy: "",
  },
  rhythm_not_heard: {
    text:
      "Im Rhythmus dieses Senders war kein Puls zu hören; auf seiner Frequenz waren es {given} Pulse anderer und {left}, die für " +
      "keinen zählen.",
    remedy: "Näher bei ihm messen; seine Periode und deren Schwankung in der Mission prüfen.",
  },
  readings_left_out: {
    text:
      "{readings|Messwert|Messwerte} weggelassen: {why?heading_unknown=keine Richtung nahe genug in der Zeit" +
      "|place_unknown=der Ort des Fluggeräts war nicht sicher|overdriven=der Empfänger war übersteuert" +
      "|at_noise=kaum über dem Rauschen|beside_a_turn=neben einem Ort, an dem es ohnehin gedreht und gehört hat" +
      "|pointed_one_way=die Antenne zeigte in eine Richtung, die Leistung sagt dann keine Peilung" +
      "|too_many=andere Abschnitte des Wegs wurden weiter gedreht}.",
    remedy: "",
  },
  nose_swung: {
    text:
      "Die Nase pendelte {swung|Mal|Mal} um {amplitude_deg} nach jeder Seite, mit {rate_deg_s} und höchstens {lag_deg} zurück" +
      "{end?near_place=, bis der Ort nahe war|not_ours=, bis ein anderer Befehl kam oder jemand anderes flog" +
      "|lags=. Dann folgte sie nicht und wurde in Ruhe gelassen|refused=. Dann lehnte der Autopilot ab, und sie wurde in Ruhe gelassen}.",
    remedy: "",
  },
  no_heading_heard: {
    text: "Das Fluggerät meldete während der Drehung keine Richtung.",
    remedy: "Seine Telemetrie und die Rate von ATTITUDE prüfen.",
  },
  headings_not_numbers: {
    text: "Die Richtungen des Fluggeräts sind keine Zahlen.",
    remedy: "Seinen Kompass kalibrieren oder den Autopiloten neu starten.",
  },
  no_position_heard: { text: "Das Fluggerät meldete während der Drehung keine Position.", remedy: "Auf GPS warten." },
  clocks_apart: {
    text: "Messwerte und Richtungen liegen {apart_s:1} auseinander.",
    remedy: "Die Uhren von Empfänger und Fluggerät nach GPS oder NTP stellen.",
  },
  headings_interrupted: {
    text: "Wo etwas zu hören war, meldete das Fluggerät mehr als {longest_s:1} lang keine Richtung.",
    remedy: "Nach Lücken in der Telemetrie suchen.",
  },
  power_not_numbers: {
    text: "Kein Leistungswert der Drehung ist eine glaubhafte Zahl.",
    remedy: "Den Empfänger neu starten.",
  },
  overdriven: {
    text: "Der Empfänger war übersteuert: {clipped} von {samples} Messwerten sind abgeschnitten.",
    remedy: "Die Verstärkung senken oder weiter weg messen.",
  },
  too_few_directions: {
    text: "Nur in {heard|Richtung|Richtungen} war etwas zu hören; rundum sind mindestens {needed} nötig.",
    remedy: "Langsamer drehen oder die Abtastrate des Empfängers erhöhen.",
  },
  turn_incomplete: {
    text: "Nur über {heard_deg} der Drehung war etwas zu hören.",
    remedy: "Einmal ganz herum drehen, während der Empfänger hört, oder näher am Sender.",
  },
  constant_power: {
    text: "Der Empfänger zeigt in jeder Richtung dieselbe Leistung: einen festen Wert, kein Signal.",
    remedy: "Seinen Antenneneingang und seine Verstärkung prüfen.",
  },
  nothing_above_noise: {
    text: "Nichts gehört: Keine Richtung liegt {needed_db:0} über dem Rauschen.",
    remedy: "Näher beim Sender messen.",
  },
  no_direction: { text: "In der Drehung steckt keine Richtung: Die Leistung ändert sich kaum mit ihr.", remedy: "" },
  unlike_antenna: {
    text: "Die Drehung sieht nicht nach der Antenne aus (Ähnlichkeit {quality:2}, nötig sind {needed:2}): Reflexionen, Störung oder kein Signal.",
    remedy: "",
  },
  direction_in_gap: {
    text: "Die stärkste Richtung liegt in einer Lücke von {gap_deg}, in der der Empfänger nicht gehört hat.",
    remedy: "",
  },
  pattern_borrowed: {
    text: "Die Peilung beruht auf dem Diagramm einer anderen Antenne ({name}) und ist deshalb unsicherer.",
    remedy: "Das Diagramm der Antenne messen, die mitfliegt: crossfix calibrate.",
  },
  likely_other_antenna: {
    text: "Die Drehung sieht nach einer anderen Antenne als {name} aus: Nur die Hauptkeule wurde verwendet.",
    remedy: "Prüfen, welche Antenne montiert ist, und ihr Diagramm messen: crossfix calibrate.",
  },
  other_direction_likely: {
    text: "Die Drehung passt fast ebenso gut zu {other_bearing_deg}.",
    remedy: "Auch von einem anderen Ort hören.",
  },
  not_the_measured_antenna: {
    text: "Das ist nicht die Antenne, die gemessen wurde: {sweeps} Drehungen weichen auf die gleiche Weise um {repeats_db:1} vom Diagramm {name} ab.",
    remedy: "Prüfen, welche Antenne montiert ist und wie, oder das vorgeschlagene Diagramm übernehmen.",
  },

  antenna_agrees: { text: "Gemessen {measured_deg}, wahr {true_deg}, Güte {quality:2}.", remedy: "" },
  emitter_too_near: {
    text: "Der Sender ist nur {distance_m} entfernt.",
    remedy: "Mindestens {least_m} von ihm entfernt drehen.",
  },
  antenna_dead: {
    text: "Die Leistung ändert sich während der Drehung nur um {heard_db}, das Diagramm um {pattern_db:0}: Die Antenne ist wohl tot oder nicht angeschlossen.",
    remedy: "Prüfen, ob Kabel, Stecker und Element der Antenne heil sind und der Prüfsender an ist.",
  },
  antenna_unlike_pattern: {
    text: "Die Drehung passt nicht zum Antennendiagramm. {because}",
    remedy: "Prüfen, ob dies die Antenne des gewählten Diagramms ist, ihr Element ganz ist und der Sender dieselbe Polarisation hat.",
  },
  antenna_askew: {
    text: "Der Sender liegt bei {true_deg}, gemessen wurde er bei {measured_deg}.",
    remedy: "Den Versatz der Antenne auf {offset_deg} setzen oder die Antenne drehen; stimmt beides, den Kompass kalibrieren.",
  },
  receiver_clock_off: {
    text: "Die Uhr des Empfängers weicht um {offset_s:2} von der des Fluggeräts ab.",
    remedy: "Beide nach GPS oder NTP stellen, dann noch einmal drehen.",
  },
  too_few_samples: {
    text: "Die Drehungen enthalten nur {samples|Messwert|Messwerte}; ein Diagramm braucht mindestens {needed}.",
    remedy: "Langsamer drehen oder mehr Drehungen fliegen.",
  },
  no_magnetic_model: {
    text: "Für das Jahr {year} gibt es kein Magnetfeldmodell.",
    remedy: "Das Paket pygeomag aktualisieren oder die Missweisung von Hand setzen.",
  },

  not_a_pattern: {
    text: "Die Datei {file} ist kein Antennendiagramm: {why?json=Sie ist kein JSON|format=Sie nennt nicht das Format „crossfix antenna pattern“|relative_bearing_deg=relative_bearing_deg fehlt|gain=gain fehlt|unit=unit fehlt|rows=Sie hat keine Zeilen „angle_deg, gain“|numbers=Ein Winkel, ein Gewinn, der Versatz oder die Frequenz ist keine endliche Zahl|counts=Nicht zu jedem Winkel gehört ein Gewinn|positive=Ein linearer Gewinn ist nicht größer als null}.",
    remedy: "Eine Datei nehmen, die crossfix calibrate schrieb, oder eine Drehtisch-Tabelle angle_deg, gain_db mit der Endung .csv.",
  },
  pattern_row_unusable: {
    text: "Zeile {line} von {file} ist nicht „angle_deg, gain“: {row}.",
    remedy: "Die Zeile berichtigen oder entfernen.",
  },
  pattern_unit_unknown: {
    text: "Die Einheit „{unit}“ der Gewinne in {file} ist nicht bekannt.",
    remedy: "„dB“ oder „linear power“ schreiben.",
  },
  too_few_points: {
    text: "Das Diagramm {name} hat nur {points|Punkt|Punkte}.",
    remedy: "Rundum mindestens {needed} messen.",
  },
  angle_twice: {
    text: "Der Winkel {angle_deg:1} kommt im Diagramm {name} zweimal vor.",
    remedy: "Eine Zeile je Winkel behalten.",
  },
  pattern_gap: {
    text: "Das Diagramm {name} hat nach {after_deg} eine Lücke von {gap_deg}.",
    remedy: "Ganz herum messen, mindestens alle {widest_deg}.",
  },
  implausible_gains: {
    text: "Der Gewinn im Diagramm {name} schwankt rundum um {spread?small=weniger|large=mehr} als {limit_db:0}.",
    remedy: "Prüfen, ob das Element der Antenne ganz ist und die Einheit der Tabelle stimmt.",
  },
  pattern_of_other_frequency: {
    text: "Das Diagramm {name} wurde bei {measured_hz:1} gemessen, nicht bei {wanted_hz:1}.",
    remedy: "Ein Diagramm nehmen, das bei der Frequenz des Senders gemessen wurde.",
  },
} satisfies Partial<ReasonTable>;
