import { afterEach, expect, it } from "vitest";
import table from "./told.json";
import { sentencesOf, tellIn, tellInUnits, told, toldName, toldReason, translated } from "./told";

afterEach(() => {
  tellIn(null);
  tellInUnits("metric");
});

it("says in English what the server said, names with a capital", () => {
  expect(told("the vehicle has no position")).toBe("the vehicle has no position");
  expect(toldName("antenna pattern")).toBe("Antenna pattern");
  expect(toldName("Failsafe NAV_DLL_ACT")).toBe("Failsafe NAV_DLL_ACT");
  expect(toldName("safety: no_fly")).toBe("Safety: no fly");
  expect(toldName("GPS")).toBe("GPS");
  expect(toldReason("not yet: no bearing taken")).toBe("no bearing taken");
});

it("puts the values of a sentence into its translation, sentences within sentences too", () => {
  tellIn(table);
  expect(toldReason("not yet: expected error 31 m, wanted below 10 m")).toBe("erwarteter Fehler 31 m, gewünscht unter 10 m");
  expect(told("not yet: both bearings from one side, crossing at 12 deg, 20 deg are needed")).toBe(
    "noch nicht: beide Peilungen von einer Seite, Schnittwinkel 12°, 20° sind nötig",
  );
  expect(told("no usable bearing here: quality 0.41 is below 0.70")).toBe("hier keine brauchbare Peilung: Güte 0,41 liegt unter 0,70");
  expect(told("receiver: silent for 6 s")).toBe("Empfänger: seit 6 s stumm");
  expect(told("not localized after 20 places (not yet: no bearing taken; not yet: 2 of 5 bearings contradict the estimate, another look is needed)")).toBe(
    "nicht gefunden nach 20 Orten (noch nicht: keine Peilung genommen; noch nicht: 2 von 5 Peilungen widersprechen der Schätzung, es braucht noch einen Blick)",
  );
  expect(toldName("safety: no_fly")).toBe("Sicherheit: Flugverbot");
  expect(told("a.csv: no usable pulse of tag 3 in any rotation; first remark: a.csv:2: a pulse needs 19 columns, this row has 7; line left out")).toBe(
    "a.csv: kein brauchbarer Puls der Kennung 3 in irgendeiner Drehung; erste Bemerkung: a.csv:2: ein Puls braucht 19 Spalten, diese Zeile hat 7; Zeile ausgelassen",
  );
});

it("gives the server's values in the operator's units", () => {
  expect(told("135181 m2 to fly in")).toBe("0.14 km² to fly in");
  expect(told("expected error 31 m, wanted below 10 m")).toBe("expected error 31 m, wanted below 10 m");
  tellInUnits("imperial");
  expect(told("135181 m2 to fly in")).toBe("33.40 acres to fly in");
  expect(told("not yet: expected error 31 m, wanted below 10 m")).toBe("not yet: expected error 102 ft, wanted below 32.8 ft");
  expect(told("wind of 12.5 m/s; 20 MHz, 30 mm, 4 m2s")).toBe("wind of 28.0 mph; 20 MHz, 30 mm, 4 m2s");
  tellIn(table);
  expect(told("135181 m2 to fly in")).toBe("33.40 acres Flugraum");
});

it("knows a sentence that the server began with a capital and ended with a dot", () => {
  tellIn(table);
  expect(told("The area has only 7 m2.")).toBe("Das Gebiet hat nur 7 m².");
  expect(told("Draw at least 100 m2.")).toBe("Mindestens 100 m² zeichnen.");
  expect(told("The moon is in the way.")).toBe("The moon is in the way.");
});

it("shows a sentence that it does not know as it came", () => {
  tellIn(table);
  expect(told("the moon is in the way")).toBe("the moon is in the way");
});

it("takes every sentence for itself and not for a vaguer one", () => {
  const known = sentencesOf(table);
  for (const [english, german] of Object.entries(table)) {
    const filled = english.replaceAll("{}", "7");
    const wanted = german.replace(/\{\d\}/g, "7");
    expect(translated(filled, known), english).toBe(wanted);
  }
});
