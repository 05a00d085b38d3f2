// German: why a place was chosen, what is still missing, and what the planner cannot do.
import type { ReasonTable } from "../reasons";

export const planner = {
  quickest_place: ["Gefunden in etwa {expected_time_s} über diesen Ort, {gain_s} eher als über jeden anderen von {places} erprobten."],
  longest_lead: [
    "Gefunden in etwa {expected_time_s} über diesen Ort; von {places} erprobten behielt er über die meisten simulierten Flüge die Spitze.",
  ],
  only_place: ["Gefunden in etwa {expected_time_s} über diesen Ort, den einzigen {among?allowed=erlaubten|tried=erprobten}."],
  soonest_together: [
    "Über diesen Ort sind die {emitters} noch gesuchten Sender im Mittel nach etwa {mean_time_s} gefunden, eher als über jeden anderen von {places} erprobten.",
  ],
  soonest_for_first: [
    "Für {names} zuerst: gefunden in etwa {first_time_s} über diesen Ort, von {places|Ort|Orten} erprobt. {others|weiterer Sender entscheidet|weitere Sender entscheiden} nur zwischen Orten, die dafür gleich gut sind.",
  ],
  quickest_place_found: [
    "Gefunden in etwa {expected_time_s} über diesen Ort, ermittelt durch {search?quadrant=Suche in Quadranten|sgd=stochastischen Gradientenabstieg|bfgs=BFGS}.",
  ],
  planned_meanwhile: [
    "Gefunden in etwa {expected_time_s} über diesen Ort, den besten von {places|Ort|Orten}. Geplant mit der einfacheren Grundregel: die Tabelle des dynamischen Programms wird noch berechnet.",
  ],
  most_information: [
    "Eine Peilung von hier engt die Karte der Wahrscheinlichkeit{about?estimate=|worst_case= im ungünstigsten Fall} am meisten ein; {places|Ort|Orte} verglichen.",
  ],
  least_entropy: ["Nach der nächsten Peilung werden {entropy_nat:2} nat erwartet, das Wenigste von {places|Ort|Orten}."],
  beside_ellipse: [
    "Quer zur langen Achse der Wahrscheinlichkeit, {distance?tabulated=auf der näheren Seite|just_outside=knapp außerhalb der Ellipse}.",
  ],
  first_of_route: [
    "Der erste von {places|Ort|Orten}, {planner?sopt=die den nahen Rand des Gebiets festlegen würden|tokekar_subset=die zusammen am meisten über die Schätzung sagen|tokekar_tree=die auch bei ungünstigen Peilungen am besten bestehen|lookahead=deren Weg am meisten über die Schätzung sagt}.",
  ],

  bearings_not_in_belief: [
    "Wo der Sender sein kann, ist mit {bearings|Peilung|Peilungen} noch nicht berechnet.",
    "Kurz warten; bleibt es dabei, die letzte Peilung weglassen.",
  ],
  no_bearing_yet: ["Es ist noch keine Peilung genommen.", "Die erste Peilung nehmen."],
  too_few_places: [
    "{bearings|Peilung|Peilungen} von {places|Ort|Orten}; {needed_places} Orte sind nötig.",
    "Von einem anderen Ort peilen.",
  ],
  too_few_places_agree: [
    "{agreeing_places} von {places|Ort|Orten} {agreeing_places?1=passt|*=passen} zur Schätzung; {needed_places} sind nötig.",
    "Von einem anderen Ort peilen.",
  ],
  crossing_angle_too_small: [
    "Alle Peilungen kommen von einer Seite: Sie schneiden sich unter nur {crossing_deg}; {needed_deg} sind nötig.",
    "Von einer anderen Seite peilen.",
  ],
  estimate_contradicted: [
    "{contradicting} von {bearings|Peilung|Peilungen} {contradicting?1=widerspricht|*=widersprechen} der Schätzung.",
    "Noch eine Peilung nehmen.",
  ],
  bearings_disagree: [
    "Die {bearings} Peilungen widersprechen sich: Mindestens eine ist ein Ausreißer.",
    "Noch eine Peilung nehmen oder den Ausreißer weglassen.",
  ],
  bearing_misses_area: ["Die Peilung zeigt am Suchgebiet vorbei.", "Das Gebiet, die Antenne und den Ort der Peilung prüfen."],
  error_may_be_far_larger: [
    "Mit {beyond_percent} Wahrscheinlichkeit ist der Sender weiter als {far_m} vom Schätzort entfernt, falls Peilungen ganz oder um denselben Winkel falsch sind; geduldet werden höchstens {most_percent}.",
    "Noch eine Peilung nehmen, am besten von der anderen Seite.",
  ],
  expected_error_too_large: [
    "Der erwartete Fehler ist {expected_error_m:1}; er muss unter {threshold_m:1} fallen.",
    "Noch eine Peilung nehmen.",
  ],

  no_place_to_fly: ["Das Fluggerät darf nirgends fliegen: Zaun und Flugverbotsgebiete lassen keinen Raum.", "Den Zaun erweitern."],
  no_place_in_reach: [
    "Von hier ist kein Ort zu erreichen, ohne den Zaun oder ein Flugverbotsgebiet zu kreuzen.",
    "Den Zaun oder die Flugverbotsgebiete ändern oder anderswo starten.",
  ],
  no_way: [
    "Zu dem {distance_m} entfernten Ort führt kein Weg, der nicht den Zaun oder ein Flugverbotsgebiet kreuzt.",
    "Einen anderen Ort wählen.",
  ],
  no_place_sees_belief: [
    "Eine Peilung von jedem erlaubten Ort ginge am wahrscheinlichen Gebiet vorbei.",
    "Den Zaun erweitern oder den Abstand zum Gebiet verringern.",
  ],
  every_place_refused: ["Jeder Ort wurde abgelehnt.", "Halten oder den nächsten Ort selbst wählen."],
  too_many_places: ["Orte im Abstand von {spacing_m} wären mehr als {most_places}.", "Den Abstand auf mindestens {finest_m} setzen."],
  budget_too_small: [
    "{rollouts|Probe ist|Proben sind} für diese Suche zu wenig.",
    "Auf mindestens {needed_rollouts|Probe|Proben} erhöhen.",
  ],
  fixed_sample_paths: [
    "Diese Auswahl braucht mehr Stichprobenpfade als die {paths} des deterministischen Verfahrens.",
    "Die Stichproben crn oder pmc wählen.",
  ],
  belief_out_of_step: [
    "Die Karte der Wahrscheinlichkeit enthält {folded|Peilung|Peilungen}, {given?1=gegeben wurde|*=gegeben wurden} {given}.",
    "Die gegebenen Peilungen einrechnen.",
  ],
  unusable_area: [
    "Das Suchgebiet {flaw?no_ring=ist leer|too_few_corners=hat weniger als drei Ecken|not_finite=hat eine Ecke ohne brauchbare Koordinaten|no_extent=hat keine Fläche: Seine Ecken liegen auf einer Linie oder in einem Punkt}.",
    "Ein Vieleck mit mindestens drei Ecken zeichnen.",
  ],
  area_crosses_itself: ["Der Umriss des Suchgebiets kreuzt sich selbst bei x = {x_m:1}, y = {y_m:1}.", "Ihn entwirren."],
  prior_outside_area: ["Das Vorwissen reicht nirgends in das Suchgebiet.", "Das Vorwissen verschieben oder das Gebiet erweitern."],
  unusable_gaussian: ["Eine Normalverteilung braucht einen endlichen Mittelwert und eine positiv definite 2×2-Kovarianz."],
  unusable_ring: ["Ein Ring braucht endliche Radien, den inneren kleiner als den äußeren."],
  mean_at_sensor: ["Der Mittelwert der Verteilung liegt am Sensor, wo eine Peilung keine Ableitung hat."],
  unusable_bearing: [
    "Eine Peilung braucht {flaw?not_finite=einen endlichen Ort, Winkel und Fehler|sigma=einen Fehler größer als null|outlier_probability=einen Ausreißeranteil von mindestens 0 und unter 1|peak=für jede weitere Spitze einen endlichen Winkel und ein positives Gewicht|profile=eine endliche Wahrscheinlichkeit in wenigstens acht Richtungen}.",
  ],
  unusable_flights: [
    "An diese Flüge lässt sich kein Flugzeitmodell anpassen: {flaw?lengths_differ=Strecken, Drehungen und Zeiten sind nicht gleich viele|too_few=Es sind weniger als vier|not_finite=Eine Strecke ist negativ, eine Zeit nicht größer als null, oder ein Wert ist nicht endlich|equal_distances=Alle sind gleich lang, darum sind Tempo und Konstante nicht zu unterscheiden}.",
  ],
  unusable_number: [
    "{quantity?sigma=Der Peilfehler|threshold=Die Schwelle des erwarteten Fehlers|measurement_time=Die Messdauer|speed=Die Geschwindigkeit im Flugzeitmodell|turn_rate=Die Drehrate im Flugzeitmodell|acceleration=Die Beschleunigung im Flugzeitmodell|movement_constant=Die Konstante im Flugzeitmodell|action_spacing=Der Abstand der Kandidaten|action_grid=Die Zellenzahl des Kandidatenrasters|platform_position=Der Ort des Fluggeräts|actions=Die Anzahl der Kandidaten|budget=Die Anzahl der Proben|horizon=Der Horizont in Peilungen|threads=Die Anzahl der Threads|levels=Die Anzahl der Stufen|paths=Die Anzahl der Stichprobenpfade} muss {wanted?positive=größer als null und endlich|not_negative=mindestens null und endlich|at_least_one=mindestens eins|finite=endlich|power_of_two=eine Zweierpotenz} sein, nicht {given}.",
  ],

  nearer_than_standoff: [
    "Der Planer hält {standoff_m} Abstand vom 95-%-Gebiet; von hier sind es {clearance_m}. Noch näher kann der Sender genau darunter liegen, wo keine Peilung zum Antennendiagramm passt; die Vorhersage weiß das nicht.",
    "Den Abstand legt der Einsatz fest.",
  ],
  tells_little_of_bias: [
    "Der Planer vergleicht nur Orte, die auch zeigen, wie falsch der Kompass geht; dieser sagt davon {share_percent} dessen, was der beste sagt, verlangt sind {wanted_percent}. Die Vorhersage lässt den Kompass außer Acht.",
    "Von einer anderen Seite sagt die Peilung beides.",
  ],
  crosses_too_little: [
    "Es fehlt nur noch eine Peilung von einer anderen Seite: Die Linien müssen sich mit {needed_deg} kreuzen, und von hier kreuzen sie sich mit {crossing_deg}. Die Vorhersage weiß das nicht.",
    "Den Winkel legt der Einsatz fest.",
  ],
  echoes_heard_before: [
    "Der Planer hält {apart_m} Abstand von Orten, an denen schon gedreht wurde; von hier sind es {away_m}. So nah hört eine Peilung dieselben Echos noch einmal und sagt kaum Neues; die Vorhersage weiß das nicht.",
    "Weiter weg von allen früheren Drehungen ist die Peilung ein Zeuge für sich.",
  ],
  between_places: [
    "Keine Regel spricht dagegen: Der Planer vergleicht Orte im Abstand von {spacing_m} mit begrenzt vielen simulierten Flügen, und Ihrer ist besser als das, was er fand.",
  ],
} satisfies Partial<ReasonTable>;
