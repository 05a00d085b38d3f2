// German: the checks before the start.
import type { ReasonTable } from "../reasons";

const WATCH =
  "{watch?station=Bodenstation verloren|station_id=Die Bodenstation, auf die sein Ausfallschutz achtet|fence=Zaun verlassen" +
  "|transmitter=Verbindung zum Handsender verloren|sticks=Die Steuerknüppel des Piloten beenden den automatischen Flug" +
  "|offboard=Offboard-Verbindung verloren, die Crossfix nicht benutzt}";
const SET_IT =
  "{parameter} auf {wanted} setzen{watch?station=: Sonst schwebt ein Fluggerät ohne seine Station, bis der Akku leer ist" +
  "|station_id=, die MAVLink-Kennung von Crossfix: Den Verlust einer anderen bemerkt der Autopilot nicht" +
  "|fence=: Sonst meldet der Autopilot nur, dass der Zaun verlassen wird|transmitter=, wenn ein Pilot mit Handsender bereitsteht" +
  "|sticks=: Die Steuerknüppel des Piloten müssen den automatischen Flug sofort beenden|offboard=}.";

export const preflight = {
  link_checked: {
    text: "{autopilot?px4=PX4|ardupilot=ArduPilot|unknown=Ein unbekannter Autopilot} ist zu hören.",
    remedy: "",
  },
  gps_checked: {
    text: "{fix?no GPS=Kein GPS|no fix=Keine Position|2D=2D-Position|3D=3D-Position|DGPS=DGPS-Position|RTK float=RTK-Position, nicht fixiert|RTK fixed=RTK-Position, fixiert|static=Feste Position|PPP=PPP-Position}, {satellites|Satellit|Satelliten}.",
    remedy: "Unter freiem Himmel auf eine 3D-Position mit mindestens {wanted_satellites|Satellit|Satelliten} warten.",
  },
  never_reported: {
    text: "Der Autopilot hat {what?gps=sein GPS|position=seine Position|heading=seine Richtung|battery=den Ladestand des Akkus|home=seinen Startplatz} nicht gemeldet.",
    remedy:
      "{what?gps=Prüfen, ob er einen GPS-Empfänger hat|position=Warten, bis der Autopilot weiß, wo er ist|heading=Den Kompass prüfen: Peilungen brauchen die Richtung des Fluggeräts|battery=Die Akkuüberwachung einrichten|home=Warten, bis der Autopilot seinen Startplatz gesetzt hat (er braucht GPS)}.",
  },
  report_age: {
    text: "Die {what?position=Position|heading=Richtung} ist {age_s:1} alt.",
    remedy:
      "{what?position=Warten, bis der Autopilot weiß, wo er ist|heading=Den Kompass prüfen: Peilungen brauchen die Richtung des Fluggeräts}.",
  },
  battery_charge: { text: "Der Akku hat {charge_percent}.", remedy: "Ihn auf mindestens {wanted_percent} laden." },
  home_set: { text: "Der Startplatz liegt bei {lat@lon}.", remedy: "" },
  arming_checked: {
    text: "{state?ready=Der Autopilot ist bereit zum Scharfschalten|not_ready=Der Autopilot ist nicht bereit zum Scharfschalten|in_the_air=Das Fluggerät ist in der Luft|not_reported=Der Autopilot meldet nicht, ob er zum Scharfschalten bereit ist}.",
    remedy: "Die Meldungen des Autopiloten lesen: Seine eigenen Prüfungen verweigern das Scharfschalten.",
  },
  control_checked: {
    text: "{who?pilot=Der Pilot steuert|failsafe=Der Ausfallschutz des Autopiloten steuert|nobody=Niemand greift ein}.",
    remedy: "{who?failsafe=Es landen lassen|*=Die Steuerung am Handsender zurückgeben, dann fortsetzen}.",
  },
  failsafe_parameter: { text: `${WATCH}: {parameter} = {value}.`, remedy: SET_IT },
  failsafe_unread: { text: `${WATCH}: {parameter} war nicht zu lesen.`, remedy: SET_IT },

  return_altitude_checked: {
    text: "Die eigene Rückkehr des Autopiloten steigt auf {altitude_relative_m} ({parameter}).",
    remedy:
      "{parameter} so setzen, dass die eigene Rückkehr des Autopiloten nicht über die Höchsthöhe der Mission von {ceiling_relative_m} steigt, oder diese anheben.",
  },
  return_altitude_unread: {
    text: "Wie hoch die eigene Rückkehr des Autopiloten steigt ({parameter}), war nicht zu lesen.",
    remedy:
      "{parameter} so setzen, dass die eigene Rückkehr des Autopiloten nicht über die Höchsthöhe der Mission von {ceiling_relative_m} steigt.",
  },
  room_to_fly: { text: "{area_m2} Flugraum.", remedy: "" },
  start_allowed: { text: "Zaun, Akku und Position erlauben den Start.", remedy: "" },
  receiver_delivers: { text: "Der Empfänger liefert Messwerte auf {channels|Kanal|Kanälen}.", remedy: "" },
  no_samples: {
    text: "Der Empfänger liefert keine Messwerte.",
    remedy: "Prüfen, ob er angesteckt ist und kein anderes Programm ihn benutzt.",
  },
  tag_unheard: {
    text: "Der Empfänger arbeitet, hört aber keinen Puls des Senders auf {frequency_hz}.",
    remedy: "Den Sender näher bringen oder hinnehmen, dass er hier außer Reichweite ist.",
  },
  pattern_in_use: { text: "Das Antennendiagramm ist {name}.", remedy: "" },
  no_vehicle_yet: {
    text: "Auf {address} hat noch kein Fluggerät geantwortet.",
    remedy: "Es einschalten und seine Funkstrecke und Adresse prüfen.",
  },
  connecting_broke: { text: "Das Verbinden mit {address} ist in Crossfix gescheitert und wird noch einmal versucht.", remedy: "" },
  preflight_failed: { text: "Prüfung vor dem Start: {because}", remedy: "{because!remedy}" },
} satisfies Partial<ReasonTable>;
