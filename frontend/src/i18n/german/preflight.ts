// German: the checks before the start.
import type { ReasonTable } from "../reasons";

const WATCH =
  "{watch?station=Bodenstation verloren|station_id=Die Bodenstation, auf die sein Ausfallschutz achtet" +
  "|station_time=Sekunden, bis er eine stumme Bodenstation für verloren hält|fence=Zaun verlassen" +
  "|transmitter=Verbindung zum Handsender verloren|sticks=Die Steuerknüppel des Piloten beenden den automatischen Flug" +
  "|offboard=Offboard-Verbindung verloren, die Crossfix nicht benutzt|battery=Akku schwach|battery_critical=Akku fast leer}";
const SET_IT =
  "{parameter} auf {wanted} setzen{watch?station=: Sonst schwebt ein Fluggerät ohne seine Station, bis der Akku leer ist" +
  "|station_id=, die MAVLink-Kennung von Crossfix: Den Verlust einer anderen bemerkt der Autopilot nicht" +
  "|station_time=: 2 bis 30 s; später bliebe ein Fluggerät ohne seine Station zu lange sich selbst überlassen" +
  "|fence=: Sonst meldet der Autopilot nur, dass der Zaun verlassen wird|transmitter=, wenn ein Pilot mit Handsender bereitsteht" +
  "|sticks=: Die Steuerknüppel des Piloten müssen den automatischen Flug sofort beenden|offboard=" +
  "|battery=: Sonst fliegt ein Fluggerät, dem niemand etwas befiehlt, bis der Akku leer ist" +
  "|battery_critical=, falls es nicht bis nach Hause kommt}.";

const FIX =
  "{fix?no GPS=Kein GPS|no fix=Keine Position|2D=2D-Position|3D=3D-Position|DGPS=DGPS-Position" +
  "|RTK float=RTK-Position, nicht fixiert|RTK fixed=RTK-Position, fixiert|static=Feste Position|PPP=PPP-Position}";

export const preflight = {
  link_checked: ["{autopilot?px4=PX4|ardupilot=ArduPilot|unknown=Ein unbekannter Autopilot} ist zu hören."],
  gps_checked: [
    `${FIX}, {satellites|Satellit|Satelliten}.`,
    "Unter freiem Himmel auf eine 3D-Position mit mindestens {wanted_satellites|Satellit|Satelliten} warten.",
  ],
  satellites_unknown: [
    `${FIX}, aber der Autopilot weiß nicht, wie viele Satelliten er hat.`,
    "Den GPS-Empfänger ansehen: Seine Position lässt sich nicht beurteilen.",
  ],
  remote_id_checked: [
    "{state?good=Der Remote-ID-Sender arbeitet|silent=Der Remote-ID-Sender ist verstummt|unknown=Kein Remote-ID-Sender meldet seinen Zustand}.",
    "{state?silent=Seine Stromversorgung und sein Kabel prüfen|*=Wo Remote ID vorgeschrieben ist, den Sender vor dem Flug auf anderem Weg prüfen}.",
  ],
  remote_id_refuses: [
    "Der Remote-ID-Sender ist nicht bereit für einen Flug: „{text}“.",
    "Beheben, was er sagt: Oft fehlt die Kennung oder der Ort des Betreibers.",
  ],
  never_reported: [
    "Der Autopilot hat {what?gps=sein GPS|position=seine Position|heading=seine Richtung|battery=den Ladestand des Akkus|home=seinen Startplatz|own_checks=den Stand seiner eigenen Prüfungen} nicht gemeldet.",
    "{what?gps=Prüfen, ob er einen GPS-Empfänger hat|position=Warten, bis der Autopilot weiß, wo er ist|heading=Den Kompass prüfen: Peilungen brauchen die Richtung des Fluggeräts|battery=Die Akkuüberwachung einrichten|home=Warten, bis der Autopilot seinen Startplatz gesetzt hat (er braucht GPS)|own_checks=Warten, bis er es tut, und prüfen, ob er SYS_STATUS sendet}.",
  ],
  report_age: [
    "Die {what?position=Position|heading=Richtung} ist {age_s:1} alt.",
    "{what?position=Warten, bis der Autopilot weiß, wo er ist|heading=Den Kompass prüfen: Peilungen brauchen die Richtung des Fluggeräts}.",
  ],
  battery_charge: ["Der Akku hat {charge_percent}.", "Ihn auf mindestens {wanted_percent} laden."],
  home_set: ["Der Startplatz liegt bei {lat@lon}."],
  arming_checked: [
    "{state?ready=Der Autopilot ist bereit zum Scharfschalten|not_ready=Der Autopilot ist nicht bereit zum Scharfschalten|not_in_this_mode=Der Autopilot ist in seinem jetzigen Modus nicht bereit zum Scharfschalten|in_the_air=Das Fluggerät ist in der Luft|not_reported=Der Autopilot meldet nicht, ob er zum Scharfschalten bereit ist}.{said?=|*= Er sagt: „}{said}{said?=|*=“.}",
    "{state?not_in_this_mode=Seinen Modus zum Halten wählen, um zu erfahren, ob er darin scharfschalten würde|*=Die Meldungen des Autopiloten lesen: Seine eigenen Prüfungen verweigern das Scharfschalten}.",
  ],
  control_checked: [
    "{who?pilot=Der Pilot steuert|failsafe=Der Ausfallschutz des Autopiloten steuert|nobody=Niemand greift ein}.",
    "{who?failsafe=Es landen lassen|*=Die Steuerung am Handsender zurückgeben, dann fortsetzen}.",
  ],
  failsafe_parameter: [`${WATCH}: {parameter} = {value}.`, SET_IT],
  failsafe_unread: [`${WATCH}: {parameter} war nicht zu lesen.`, SET_IT],
  failsafe_without_threshold: [
    `${WATCH}: {parameter} ist gesetzt, aber {voltage_parameter} und {charge_parameter} {known?true=sind beide 0: Es greift nie ein|false=waren nicht beide zu lesen: Vielleicht greift es nie ein}.`,
    "{voltage_parameter} auf die Spannung oder {charge_parameter} auf die restlichen mAh setzen, bei denen es eingreifen soll.",
  ],

  parameter_to_set: ["{parameter} geht von {before} auf {after}."],
  nets_to_set: [
    "Der Start setzt den eigenen Zaun des Autopiloten: {corners|Ecke|Ecken}, {no_fly|Flugverbotszone|Flugverbotszonen}. {own_zones?0=Einen anderen hat er nicht|*=Sein eigener macht solange Platz}; nach dem Flug wird alles wiederhergestellt, wie es war. {changes}",
  ],
  own_ceiling_lower: [
    "Der eigene Zaun des Autopiloten endet bei {own_m} ({parameter}), der der Mission bei {ceiling_m}.",
    "Die größte Höhe der Mission senken oder {parameter} mit der Bodenstation des Fluggeräts erhöhen.",
  ],
  own_fence_tighter: [
    "Der Zaun der Mission reicht {beyond_m} über den Zaun hinaus, den der Autopilot schon hat.",
    "Den Zaun der Mission darin zeichnen oder den des Fluggeräts mit seiner Bodenstation ändern.",
  ],
  fence_too_detailed: [
    "Zaun und Flugverbotszonen haben {corners|Ecke|Ecken}; der Autopilot fasst {most}.",
    "Sie mit weniger Ecken zeichnen.",
  ],
  fence_not_transferred: [
    "Der Zaun des Autopiloten ließ sich nicht {way?read=lesen|sent=senden} ({why}).",
    "Die Funkstrecke prüfen; ein Zaun auf der Speicherkarte des Autopiloten kann beschädigt sein.",
  ],
  fence_unknown_form: [
    "Der Autopilot hat einen Zaun, den Crossfix nicht versteht ({what}).",
    "Ihn mit der Bodenstation des Fluggeräts ansehen und dort löschen.",
  ],
  fence_read_back_different: [
    "Der Autopilot hat einen anderen Zaun, als ihm gesendet wurde: Ecke {corner} weicht ab.",
    "Noch einmal versuchen; bleibt es dabei, den Zaun mit der Bodenstation des Fluggeräts setzen.",
  ],
  fence_parameter_unread: [
    "Der Zaun des Autopiloten lässt sich nicht beurteilen: {parameter} war nicht zu lesen.",
    "Die Funkstrecke prüfen und es noch einmal versuchen.",
  ],

  return_altitude_checked: [
    "Die eigene Rückkehr des Autopiloten steigt auf {altitude_relative_m} ({parameter}).",
    "{parameter} so setzen, dass die eigene Rückkehr des Autopiloten nicht über die Höchsthöhe der Mission von {ceiling_relative_m} steigt, oder diese anheben.",
  ],
  return_meets_ground: [
    "Die eigene Rückkehr des Autopiloten steigt auf {altitude_relative_m} ({parameter}) und fliegt geradeaus heim: Über dem Gelände dazwischen braucht sie {least_relative_m}.",
    "{parameter} auf mindestens {least_relative_m} setzen und die Höchsthöhe der Mission nicht niedriger; oder einen anderen Startplatz wählen.",
  ],
  return_altitude_unread: [
    "Wie hoch die eigene Rückkehr des Autopiloten steigt ({parameter}), war nicht zu lesen.",
    "{parameter} so setzen, dass die eigene Rückkehr des Autopiloten nicht über die Höchsthöhe der Mission von {ceiling_relative_m} steigt.",
  ],
  return_climbs: [
    "Die eigene Rückkehr des Autopiloten steigt um {climb_m}, wo immer sie beginnt ({parameter}): Von {from_relative_m} aus führt das über die Höchsthöhe der Mission von {ceiling_relative_m}.",
    "{parameter} auf 0 setzen oder die Höchsthöhe der Mission anheben.",
  ],
  home_moves_here: [
    "Der Startplatz des Autopiloten liegt {away_m} entfernt. Er rückt beim Scharfschalten hierher, wenn ihn niemand festgelegt hat; sonst führt seine eigene Rückkehr dorthin.",
    "Hat eine Bodenstation den Startplatz gesetzt, ihn dorthin setzen, wo das Fluggerät steht.",
  ],
  room_to_fly: ["{area_m2} Flugraum."],
  start_allowed: ["Zaun, Akku und Position erlauben den Start."],
  receiver_delivers: ["Der Empfänger liefert Messwerte auf {channels|Kanal|Kanälen}."],
  receiver_takes_turns: [
    "Der Empfänger arbeitet. In sein Band passen die {channels} Kanäle in {rounds} Gruppen, eine nach der anderen: Für jede dreht " +
      "es einmal ganz, das dauert an jedem Ort {turn_s}, und weniger, wenn Sender gefunden sind.",
  ],
  turn_takes_long: [
    "Der Empfänger arbeitet. Die Pulse kommen so selten, dass eine Drehung an jedem Ort bis zu {turn_s} dauert.",
    "Wo sie alle paar Sekunden kommen, verkürzen weniger davon je Richtung sie; darauf achten, dass die Batterie für zwei Drehungen reicht.",
  ],
  few_turns_on_a_battery: [
    "Eine Drehung dauert {turn_s}. Solange Wind und Fluggerät nicht bekannt sind, reicht auch ein voller Akku nicht sicher für " +
      "{turns} davon mitten im Gebiet, und mit weniger kommt keine Suche aus.",
    "Weniger Sender oder ein Signal suchen, das öfter gesendet wird, oder die Reserve eines Fluggeräts senken, das lange in der " +
      "Luft bleibt.",
  ],
  few_turns_on_this_charge: [
    "Bei {charge_percent} reicht der Akku vielleicht nicht für {turns} Drehungen zu {turn_s}, die Wege ans ferne Ende des Gebiets " +
      "und nach Hause und die Reserve. Mit weniger Drehungen kommt keine Suche aus.",
    "Den Akku wechseln, oder damit rechnen, dass das Fluggerät heimkehrt, bevor es etwas gefunden hat.",
  ],
  first_turn_in_little_wind: [
    "Bei Wind reicht der Akku mit {charge_percent} vielleicht nicht für die erste Drehung in {far_m} Entfernung und den Heimweg.",
    "Näher am Gebiet oder mit vollerem Akku starten, oder damit rechnen, dass das Fluggerät heimkehrt, bevor es gedreht hat.",
  ],
  no_samples: ["Der Empfänger liefert keine Messwerte.", "Prüfen, ob er angesteckt ist und kein anderes Programm ihn benutzt."],
  tag_unheard: [
    "Der Empfänger arbeitet, hört aber keinen Puls des Senders auf {frequency_hz}.",
    "Den Sender näher bringen oder hinnehmen, dass er hier außer Reichweite ist.",
  ],
  pattern_in_use: ["Das Antennendiagramm ist {name}."],
  no_vehicle_yet: ["Auf {address} hat noch kein Fluggerät geantwortet.", "Es einschalten und seine Funkstrecke und Adresse prüfen."],
  connecting_broke: ["Das Verbinden mit {address} ist in Crossfix gescheitert und wird noch einmal versucht."],
  preflight_failed: ["Prüfung vor dem Start: {because}", "{because!remedy}"],
} satisfies Partial<ReasonTable>;
