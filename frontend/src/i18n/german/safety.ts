// German: what the safety refuses and what is not possible now.
import type { ReasonTable } from "../reasons";

export const safety = {
  failsafe_acts: ["Der Autopilot handelt von selbst: {mode}.", "Erst halten oder fortsetzen."],
  pilot_controls: [
    "Der Pilot steuert: Nichts wird an das Fluggerät gesendet.",
    "Fortsetzen, wenn der Pilot die Steuerung zurückgegeben hat.",
  ],
  not_given_back: [
    "Der Pilot hat die Steuerung nicht zurückgegeben: Das Fluggerät ist noch in {mode}.",
    "Der Pilot wählt am Handsender HOLD (PX4) oder BRAKE oder GUIDED (ArduPilot), dann fortsetzen.",
  ],
  no_link: [
    "Die Funkstrecke zum Fluggerät ist weg.",
    "Warten, bis das Fluggerät wieder antwortet; solange handelt sein eigener Ausfallschutz.",
  ],
  no_position: ["Das Fluggerät hat keine Position.", "Auf GPS warten."],
  position_old: ["Die Position des Fluggeräts ist {age_s:1} alt.", "Warten, bis wieder Telemetrie kommt."],
  battery_unknown: [
    "Das Fluggerät meldet seinen Akku nicht.",
    "Die Akkuüberwachung einrichten oder in der Mission sagen, dass dieses Fluggerät keinen Akku meldet.",
  ],
  battery_silent: ["Der Ladestand des Akkus wird nicht mehr gemeldet.", "Die Akkuüberwachung prüfen."],
  battery_short: [
    "Akku {charge_percent}: Der Heimweg begänne bei {left_percent} und braucht {needed_percent}; die Reserve ist {reserve_percent}.",
    "Heimkehren und den Akku wechseln.",
  ],
  turn_beyond_battery: [
    "Eine Drehung dauert {turn_s}; dafür werden {takes_percent} eines Akkus angesetzt, solange Wind und Fluggerät nicht bekannt sind. " +
      "Mit {needed_percent} für den Heimweg und einer Reserve von {reserve_percent} reicht auch ein voller nicht.",
    "Weniger Sender oder ein Signal suchen, das öfter gesendet wird, oder die Reserve eines Fluggeräts senken, das lange in der " +
      "Luft bleibt.",
  ],
  first_turn_beyond_charge: [
    "Akku {charge_percent}: Das Fluggerät käme heim, bevor es in {far_m} Entfernung zum ersten Mal gedreht hat. Für Hinweg und " +
      "Drehung werden {takes_percent} angesetzt, für den Heimweg {needed_percent}, und die Reserve ist {reserve_percent}.",
    "Den Akku laden oder wechseln, näher am Gebiet starten oder ein näheres einzeichnen.",
  ],
  first_turn_beyond_battery: [
    "Das Fluggerät käme heim, bevor es in {far_m} Entfernung zum ersten Mal gedreht hat: Solange Wind und Fluggerät nicht bekannt " +
      "sind, werden für Hinweg und Drehung {takes_percent} angesetzt, für den Heimweg {needed_percent}, und die Reserve ist " +
      "{reserve_percent}. So voll ist kein Akku.",
    "Näher am Gebiet starten, ein näheres einzeichnen oder die Reserve eines Fluggeräts senken, das lange in der Luft bleibt.",
  ],
  altitude_outside: [
    "{altitude_relative_m} über dem Startplatz liegt außerhalb der erlaubten {lowest_relative_m} bis {highest_relative_m}.",
    "Die Höhe der Mission oder ihren Bereich ändern.",
  ],
  too_far_from_home: ["Der Ort ist {distance_m} vom Startplatz entfernt, mehr als {most_m}.", "Einen Ort näher am Startplatz wählen."],
  already_in_air: ["Das Fluggerät ist schon in der Luft.", "Landen; eine Mission beginnt am Boden."],
  outside_fence: [
    "{what?vehicle_stands=Das Fluggerät steht|vehicle=Das Fluggerät ist|home=Der Startplatz liegt|place=Der Ort liegt} {beyond_m} außerhalb des Zauns.",
    "{what?place=Einen Ort darin wählen oder den Zaun erweitern.|*=Den Zaun um das Fluggerät und seinen Startplatz ziehen.}",
  ],
  inside_no_fly: [
    "{what?vehicle_stands=Das Fluggerät steht|vehicle=Das Fluggerät ist|home=Der Startplatz liegt|place=Der Ort liegt} in einem Flugverbotsgebiet.",
    "{what?place=Einen Ort außerhalb wählen.|*=Die Flugverbotsgebiete neben das Fluggerät und seinen Startplatz zeichnen.}",
  ],
  near_no_fly: [
    "Der Ort liegt {near_m:1} neben einem Flugverbotsgebiet, und ein schwebendes Fluggerät steht nie ganz still.",
    "Einen Ort mindestens {least_m} neben dem Gebiet wählen.",
  ],
  no_way_home: [
    "Von hier führt kein Weg um die Flugverbotsgebiete herum und innerhalb des Zauns zum {distance_m} entfernten Startplatz.",
    "Zaun und Flugverbotsgebiete so zeichnen, dass es einen gibt.",
  ],
  way_leaves_fence: ["Der Weg dorthin verlässt den Zaun.", "Über einen Ort dazwischen fliegen."],
  way_crosses_no_fly: ["Der Weg dorthin kreuzt ein Flugverbotsgebiet.", "Über einen Ort neben dem Gebiet fliegen."],

  not_started: ["Die Mission hat nicht begonnen.", "Sie zuerst starten."],
  already_started: ["Die Mission hat schon begonnen.", "Für den nächsten Flug eine neue entwerfen."],
  mission_over: ["Die Mission ist zu Ende.", "Eine neue entwerfen."],
  not_held: ["Die Mission ist nicht angehalten.", "Erst anhalten, um von hier aus weiterzumachen."],
  no_countdown: ["Es wird nicht zurückgezählt: Es ist vorbei oder wurde schon gestoppt."],
  landing_already: ["Das Fluggerät landet schon am Startplatz.", "Halten unterbricht die Landung."],
  on_the_way_home: ["Das Fluggerät ist auf dem Heimweg.", "Zum Weitersuchen erst halten und fortsetzen."],
  on_the_ground: ["Das Fluggerät ist am Boden."],
  nets_changing: [
    "Der Autopilot hat den Zaun des neuen Suchgebiets noch nicht.",
    "Er bekommt ihn, bis er ihn hat; Rückkehr und Landung warten nicht.",
  ],
  area_only_in_hold: ["Das Suchgebiet lässt sich nur ändern, während die Mission hält.", "Halten, dann ändern."],
  place_refused_before: [
    "Der Ort ist {near_m:1} von einem entfernt, zu dem der Autopilot nicht fliegen wollte.",
    "Einen Ort wählen, der mindestens {least_m} davon entfernt ist.",
  ],
  no_proposed_place: ["Es ist kein Ort vorgeschlagen.", "Auf den nächsten Ort des Planers warten."],
  no_such_bearing: ["Diese Peilung hat die Mission nicht.", "Die Seite neu laden."],
  bearing_of_another: ["Diese Peilung wurde unter einem anderen Namen gemeldet.", "Einen Bediener bitten, sie wegzulassen."],
  bearing_excluded_already: ["Die Peilung ist schon weggelassen."],
  bearing_counts_already: ["Die Peilung wurde nicht weggelassen."],
  left_out_by_another: ["{by} hat es weggelassen.", "{by} oder wer die Suche steuert kann es wieder zählen lassen."],
  no_such_source: ["Von dort hat diese Suche keine Peilung.", "Die Seite neu laden."],
  muted_already: ["Die Quelle ist {muted?true=schon stumm|false=nicht stumm}."],
  no_such_alert: ["Diesen offenen Alarm gibt es nicht.", "Er ist vielleicht von selbst vorbei."],
  no_such_craft: ["Für diese Mission fliegt kein Fluggerät {craft_id}.", "Die Seite neu laden."],
  no_such_emitter: ["Diese Mission sucht keinen Sender {emitter_id}.", "Die Seite neu laden."],
  too_many_variants: ["Diese Mission hat {most} Varianten, mehr darf sie nicht haben.", "Zuerst eine davon vergessen."],
  vehicle_unknown: ["Vom Fluggerät ist nichts bekannt.", "Das Fluggerät verbinden und noch einmal fragen."],
  no_home: ["Der Startplatz des Fluggeräts ist noch nicht bekannt.", "Auf GPS warten."],
  another_mission_flies: ["Eine andere Mission fliegt noch: {name}.", "Sie beenden und das Fluggerät zuerst landen lassen."],
  no_mission: ["Es gibt keine Mission {mission_id}.", "In der Liste der Missionen nachsehen."],
  later_order_counts: ["Ein Befehl, der auf derselben Seite später gegeben wurde, ist schon angenommen."],
  not_editable: [
    "Die Mission ist gestartet und lässt sich nicht mehr bearbeiten.",
    "Während sie hält, ihr Suchgebiet ändern, oder eine neue Mission entwerfen.",
  ],
  edited_meanwhile: [
    "Seit Sie die Mission geöffnet haben, wurde sie gespeichert von {by}.",
    "Ansehen, was gespeichert wurde; dann Ihre Fassung darüber speichern oder von der anderen aus neu beginnen.",
  ],
  drafted_before: ["Die Mission {mission_id} ist schon entworfen.", "Sie öffnen und ändern."],
  mission_flies: ["Eine Mission fliegt.", "Die Antenne prüfen, wenn das Fluggerät am Boden ist."],
  still_under_way: ["Die Mission ist noch im Gang.", "Sie löschen, wenn sie vorbei ist und das Fluggerät am Boden steht."],
  was_deleted: ["Die Mission wurde gelöscht.", "Sie zuerst wiederherstellen: In der Liste der Missionen steht sie unter den gelöschten."],
  server_is_ending: ["Der Server wird beendet: Er hält nur noch, kehrt zurück und landet.", "Ihn zuerst wieder starten."],
  mission_does_not_fly: ["Die Mission fliegt nicht.", "Den Entwurf bearbeiten oder eine neue Mission entwerfen."],
} satisfies Partial<ReasonTable>;
