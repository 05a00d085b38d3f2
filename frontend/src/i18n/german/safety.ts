// German: what the safety refuses and what is not possible now.
import type { ReasonTable } from "../reasons";

export const safety = {
  failsafe_acts: { text: "Der Autopilot handelt von selbst: {mode}.", remedy: "Erst halten oder fortsetzen." },
  pilot_controls: {
    text: "Der Pilot steuert: Nichts wird an das Fluggerät gesendet.",
    remedy: "Fortsetzen, wenn der Pilot die Steuerung zurückgegeben hat.",
  },
  not_given_back: {
    text: "Der Pilot hat die Steuerung nicht zurückgegeben: Das Fluggerät ist noch in {mode}.",
    remedy: "Der Pilot wählt am Handsender HOLD (PX4) oder BRAKE oder GUIDED (ArduPilot), dann fortsetzen.",
  },
  no_link: {
    text: "Die Funkstrecke zum Fluggerät ist weg.",
    remedy: "Warten, bis das Fluggerät wieder antwortet; solange handelt sein eigener Ausfallschutz.",
  },
  no_position: { text: "Das Fluggerät hat keine Position.", remedy: "Auf GPS warten." },
  position_old: { text: "Die Position des Fluggeräts ist {age_s:1} alt.", remedy: "Warten, bis wieder Telemetrie kommt." },
  battery_unknown: {
    text: "Das Fluggerät meldet seinen Akku nicht.",
    remedy: "Die Akkuüberwachung einrichten oder in der Mission sagen, dass dieses Fluggerät keinen Akku meldet.",
  },
  battery_silent: { text: "Der Ladestand des Akkus wird nicht mehr gemeldet.", remedy: "Die Akkuüberwachung prüfen." },
  battery_short: {
    text: "Akku {charge_percent}: Der Heimweg begänne bei {left_percent} und braucht {needed_percent}; die Reserve ist {reserve_percent}.",
    remedy: "Heimkehren und den Akku wechseln.",
  },
  turn_beyond_battery: {
    text:
      "Eine Drehung dauert {turn_s}; dafür werden {takes_percent} eines Akkus angesetzt, solange Wind und Fluggerät nicht bekannt sind. " +
      "Mit {needed_percent} für den Heimweg und einer Reserve von {reserve_percent} reicht auch ein voller nicht.",
    remedy:
      "Weniger Sender oder ein Signal suchen, das öfter gesendet wird, oder die Reserve eines Fluggeräts senken, das lange in der " +
      "Luft bleibt.",
  },
  first_turn_beyond_charge: {
    text:
      "Akku {charge_percent}: Das Fluggerät käme heim, bevor es in {far_m} Entfernung zum ersten Mal gedreht hat. Für Hinweg und " +
      "Drehung werden {takes_percent} angesetzt, für den Heimweg {needed_percent}, und die Reserve ist {reserve_percent}.",
    remedy: "Den Akku laden oder wechseln, näher am Gebiet starten oder ein näheres einzeichnen.",
  },
  first_turn_beyond_battery: {
    text:
      "Das Fluggerät käme heim, bevor es in {far_m} Entfernung zum ersten Mal gedreht hat: Solange Wind und Fluggerät nicht bekannt " +
      "sind, werden für Hinweg und Drehung {takes_percent} angesetzt, für den Heimweg {needed_percent}, und die Reserve ist " +
      "{reserve_percent}. So voll ist kein Akku.",
    remedy: "Näher am Gebiet starten, ein näheres einzeichnen oder die Reserve eines Fluggeräts senken, das lange in der Luft bleibt.",
  },
  altitude_outside: {
    text: "{altitude_relative_m} über dem Startplatz liegt außerhalb der erlaubten {lowest_relative_m} bis {highest_relative_m}.",
    remedy: "Die Höhe der Mission oder ihren Bereich ändern.",
  },
  too_far_from_home: {
    text: "Der Ort ist {distance_m} vom Startplatz entfernt, mehr als {most_m}.",
    remedy: "Einen Ort näher am Startplatz wählen.",
  },
  already_in_air: { text: "Das Fluggerät ist schon in der Luft.", remedy: "Landen; eine Mission beginnt am Boden." },
  outside_fence: {
    text: "{what?vehicle_stands=Das Fluggerät steht|vehicle=Das Fluggerät ist|home=Der Startplatz liegt|place=Der Ort liegt} {beyond_m} außerhalb des Zauns.",
    remedy: "{what?place=Einen Ort darin wählen oder den Zaun erweitern.|*=Den Zaun um das Fluggerät und seinen Startplatz ziehen.}",
  },
  inside_no_fly: {
    text: "{what?vehicle_stands=Das Fluggerät steht|vehicle=Das Fluggerät ist|home=Der Startplatz liegt|place=Der Ort liegt} in einem Flugverbotsgebiet.",
    remedy: "{what?place=Einen Ort außerhalb wählen.|*=Die Flugverbotsgebiete neben das Fluggerät und seinen Startplatz zeichnen.}",
  },
  near_no_fly: {
    text: "Der Ort liegt {near_m:1} neben einem Flugverbotsgebiet, und ein schwebendes Fluggerät steht nie ganz still.",
    remedy: "Einen Ort mindestens {least_m} neben dem Gebiet wählen.",
  },
  no_way_home: {
    text: "Von hier führt kein Weg um die Flugverbotsgebiete herum und innerhalb des Zauns zum {distance_m} entfernten Startplatz.",
    remedy: "Zaun und Flugverbotsgebiete so zeichnen, dass es einen gibt.",
  },
  way_leaves_fence: { text: "Der Weg dorthin verlässt den Zaun.", remedy: "Über einen Ort dazwischen fliegen." },
  way_crosses_no_fly: {
    text: "Der Weg dorthin kreuzt ein Flugverbotsgebiet.",
    remedy: "Über einen Ort neben dem Gebiet fliegen.",
  },

  not_started: { text: "Die Mission hat nicht begonnen.", remedy: "Sie zuerst starten." },
  already_started: { text: "Die Mission hat schon begonnen.", remedy: "Für den nächsten Flug eine neue entwerfen." },
  mission_over: { text: "Die Mission ist zu Ende.", remedy: "Eine neue entwerfen." },
  not_held: { text: "Die Mission ist nicht angehalten.", remedy: "Erst anhalten, um von hier aus weiterzumachen." },
  no_countdown: { text: "Es wird nicht zurückgezählt: Es ist vorbei oder wurde schon gestoppt.", remedy: "" },
  landing_already: { text: "Das Fluggerät landet schon am Startplatz.", remedy: "Halten unterbricht die Landung." },
  on_the_way_home: {
    text: "Das Fluggerät ist auf dem Heimweg.",
    remedy: "Zum Weitersuchen erst halten und fortsetzen.",
  },
  on_the_ground: { text: "Das Fluggerät ist am Boden.", remedy: "" },
  nets_changing: {
    text: "Der Autopilot hat den Zaun des neuen Suchgebiets noch nicht.",
    remedy: "Er bekommt ihn, bis er ihn hat; Rückkehr und Landung warten nicht.",
  },
  area_only_in_hold: {
    text: "Das Suchgebiet lässt sich nur ändern, während die Mission hält.",
    remedy: "Halten, dann ändern.",
  },
  place_refused_before: {
    text: "Der Ort ist {near_m:1} von einem entfernt, zu dem der Autopilot nicht fliegen wollte.",
    remedy: "Einen Ort wählen, der mindestens {least_m} davon entfernt ist.",
  },
  no_proposed_place: { text: "Es ist kein Ort vorgeschlagen.", remedy: "Auf den nächsten Ort des Planers warten." },
  no_such_bearing: { text: "Diese Peilung hat die Mission nicht.", remedy: "Die Seite neu laden." },
  bearing_of_another: {
    text: "Diese Peilung wurde unter einem anderen Namen gemeldet.",
    remedy: "Einen Bediener bitten, sie wegzulassen.",
  },
  bearing_excluded_already: { text: "Die Peilung ist schon weggelassen.", remedy: "" },
  bearing_counts_already: { text: "Die Peilung wurde nicht weggelassen.", remedy: "" },
  left_out_by_another: {
    text: "{by} hat es weggelassen.",
    remedy: "{by} oder wer die Suche steuert kann es wieder zählen lassen.",
  },
  no_such_source: { text: "Von dort hat diese Suche keine Peilung.", remedy: "Die Seite neu laden." },
  muted_already: { text: "Die Quelle ist {muted?true=schon stumm|false=nicht stumm}.", remedy: "" },
  no_such_alert: { text: "Diesen offenen Alarm gibt es nicht.", remedy: "Er ist vielleicht von selbst vorbei." },
  no_such_craft: { text: "Für diese Mission fliegt kein Fluggerät {craft_id}.", remedy: "Die Seite neu laden." },
  no_such_emitter: { text: "Diese Mission sucht keinen Sender {emitter_id}.", remedy: "Die Seite neu laden." },
  too_many_variants: {
    text: "Diese Mission hat {most} Varianten, mehr darf sie nicht haben.",
    remedy: "Zuerst eine davon vergessen.",
  },
  vehicle_unknown: {
    text: "Vom Fluggerät ist nichts bekannt.",
    remedy: "Das Fluggerät verbinden und noch einmal fragen.",
  },
  no_home: { text: "Der Startplatz des Fluggeräts ist noch nicht bekannt.", remedy: "Auf GPS warten." },
  another_mission_flies: {
    text: "Eine andere Mission fliegt noch: {name}.",
    remedy: "Sie beenden und das Fluggerät zuerst landen lassen.",
  },
  no_mission: { text: "Es gibt keine Mission {mission_id}.", remedy: "In der Liste der Missionen nachsehen." },
  not_editable: {
    text: "Die Mission ist gestartet und lässt sich nicht mehr bearbeiten.",
    remedy: "Während sie hält, ihr Suchgebiet ändern, oder eine neue Mission entwerfen.",
  },
  mission_flies: { text: "Eine Mission fliegt.", remedy: "Die Antenne prüfen, wenn das Fluggerät am Boden ist." },
  still_under_way: {
    text: "Die Mission ist noch im Gang.",
    remedy: "Sie löschen, wenn sie vorbei ist und das Fluggerät am Boden steht.",
  },
  was_deleted: {
    text: "Die Mission wurde gelöscht.",
    remedy: "Sie zuerst wiederherstellen: In der Liste der Missionen steht sie unter den gelöschten.",
  },
  server_is_ending: {
    text: "Der Server wird beendet: Er hält nur noch, kehrt zurück und landet.",
    remedy: "Ihn zuerst wieder starten.",
  },
  mission_does_not_fly: {
    text: "Die Mission fliegt nicht.",
    remedy: "Den Entwurf bearbeiten oder eine neue Mission entwerfen.",
  },
} satisfies Partial<ReasonTable>;
