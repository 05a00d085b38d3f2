// German: offline maps, overlays and areas.
import type { ReasonTable } from "../reasons";

const ONLY_PMTILES =
  "Verwendbar sind nur PMTiles-Archive (.pmtiles, Version 3). MBTiles-Dateien lassen sich mit `pmtiles convert` umwandeln.";
const WHAT = "{what?area=Das Gebiet|fence=Der Zaun|no_fly=Ein Flugverbotsgebiet|confidence_region=Das Vertrauensgebiet}";

export const maps = {
  not_an_archive: [
    "Die Datei ist kein PMTiles-Archiv{looks_like?none=|empty=: Sie ist leer|sqlite=, sie sieht nach MBTiles oder einer anderen SQLite-Datei aus|zip=, sondern eine ZIP-Datei|gzip=, sie ist mit gzip gepackt|tiff=, sondern ein TIFF-Bild|png=, sondern ein PNG-Bild|jpeg=, sondern ein JPEG-Bild|json=, sie sieht nach JSON aus|xml=, sie sieht nach XML oder einer Webseite aus}.",
    ONLY_PMTILES,
  ],
  old_archive: ["Das PMTiles-Archiv hat Version {version}; nötig ist Version 3.", ONLY_PMTILES],
  tiles_not_drawable: [
    "Die Kacheln des Archivs sind vom Typ {tile_type}, den die Karte nicht zeichnen kann.",
    "Vektorkacheln müssen MVT sein, Bilder PNG, JPEG, WebP oder AVIF.",
  ],
  compression_not_read: [
    "Das Archiv ist mit {compression} gepackt, was ein Browser nicht entpacken kann.",
    "Es mit gzip packen, der Vorgabe der PMTiles-Werkzeuge.",
  ],
  archive_damaged: [
    "Das PMTiles-Archiv ist {part?header=im Kopf|metadata=in den Metadaten|directories=in den Verzeichnissen|tiles=in den Kacheln|first_tile=in der ersten Kachel} beschädigt: {fault?cut_off=Es ist weniger da als angegeben|unreadable=Das ist nicht lesbar|senseless=Die Werte ergeben keinen Sinn|too_large=Es ist mehr, als eine Karte braucht|missing=Da ist nichts|endless=Es verweist endlos auf sich selbst|not_as_stated=Das Bild ist nicht von der angegebenen Art}.",
    "{fault?cut_off=Die ganze Datei noch einmal kopieren oder herunterladen.|*=Die Karte neu ausgeben oder ausschneiden, zum Beispiel mit `pmtiles extract`, und die neue Datei hochladen.}",
  ],
  map_label_damaged: ["Die Beschreibung der Karte fehlt oder ist beschädigt.", "Die Karte noch einmal hochladen."],
  put_by_hand: ["Sie wurde von Hand in den Kartenordner gelegt.", "Sie stattdessen auf der Seite hochladen."],
  map_unusable: ["Karte {file}: {because}", "{because!remedy}"],
  upload_incomplete: ["Nur {arrived_bytes} von {announced_bytes} kamen an.", "Die Datei noch einmal hochladen; nichts wurde behalten."],
  positions_thinned: ["Von {before} Positionen werden {after} gezeichnet; Linien liegen höchstens {tolerance_m:1} neben denen der Datei."],
  overlay_unusable: ["Überlagerung {file}: Ihre Beschreibung ist beschädigt.", "Die Überlagerung noch einmal hochladen."],
  mission_too_heavy: [
    "Das wurde nicht ausgerechnet: {limit?time=es dauerte zu lange|memory=es brauchte zu viel Speicher|depth=es ist zu tief verschachtelt|process=der Prozess, der daran arbeitete, endete|busy=zu viel anderes wird gerade ausgerechnet} (eine Mission darf {most_s} dauern und {most_bytes} Speicher brauchen). Nichts ist verloren, und der Flug geht weiter.",
    "{limit?busy=Kurz warten und noch einmal fragen.|*=Weniger davon verlangen: ein Format, oder eine frühere Karte.}",
  ],
  file_too_heavy: [
    "Die Datei wurde nicht zu Ende gelesen: {limit?time=Es dauerte zu lange|memory=Es brauchte zu viel Speicher|depth=Sie ist zu tief verschachtelt|process=Der Prozess, der sie las, ist beendet} (eine Datei darf {most_s} und {most_bytes} Speicher brauchen). Nichts davon wurde behalten.",
    "Vereinfachen oder teilen Sie die Datei, und laden Sie die Teile hoch.",
  ],
  readers_busy: [
    "{waiting|andere Datei wartet|andere Dateien warten} darauf, gelesen zu werden.",
    "Warten Sie einen Augenblick, und laden Sie die Datei dann noch einmal hoch.",
  ],
  disk_full: [
    "Die Festplatte ist voll. Von der Datei wurde nichts behalten.",
    "Löschen Sie Karten, Überlagerungen oder andere Dateien, und laden Sie sie dann noch einmal hoch.",
  ],
  no_room_for_map: [
    "Die Datei passt nicht: {needed_bytes} mehr sind nötig, {room_bytes} dürfen belegt werden.",
    "Karten oder Überlagerungen löschen, die nicht gebraucht werden. {reserve_bytes} bleiben frei für das Journal.",
  ],
  map_drawn_plainly: [
    "{because?layers_not_named=Das Archiv sagt nicht, welche Ebenen seine Kacheln haben; darum ist nichts davon zu zeichnen|schema_unknown=Die Ebenen der Karte folgen keinem hier bekannten Schema; alle werden gleich gezeichnet}.",
  ],
  area_on_maps: [
    "{shown?whole=Das ganze Gebiet liegt auf den Offline-Karten|partly=Nur ein Teil des Gebiets liegt auf den Offline-Karten; der Rest ist einfaches Raster|not_finely=Keine Offline-Karte zeigt das Gebiet fein genug, um danach zu fliegen: Gezeigt wird das einfache Raster|no_map=Es gibt keine Offline-Karte: Gezeigt wird das einfache Raster} ({shown_percent}).",
  ],
  beyond_web_maps: ["Das Gebiet liegt jenseits von 85 Grad Breite, wo Webkarten enden.", "Mit dem einfachen Raster fliegen."],
  not_readable_as: [
    "Die Datei ist nicht als {format?geojson=GeoJSON|kml=KML|kmz=KMZ|none=GeoJSON, KML oder KMZ} lesbar: {fault?empty=Sie ist leer|other_format=Sie ist etwas anderes|not_json=Sie ist kein gültiges JSON|no_type=Sie ist JSON ohne `type`|no_features=Ihre FeatureCollection hat keine Liste `features`|not_xml=Sie ist kein gültiges XML|document_type=Sie enthält eine Dokumenttyp-Definition|other_xml=Ihr erstes Element ist nicht <kml>|not_unpacked=Sie lässt sich nicht entpacken|no_kml_inside=Es ist keine KML-Datei darin|too_large=Sie ist entpackt viel zu groß}.",
    "Sie als GeoJSON in WGS84 (Länge, Breite) ausgeben oder als KML oder KMZ mit Placemarks.",
  ],
  other_coordinates: ["Die Datei benutzt das Koordinatensystem {system}, nicht WGS84.", "Sie in WGS84 (Länge, Breite) ausgeben."],
  too_many_features: [
    "Die Überlagerung hat mehr als {most} Objekte.",
    "Weglassen, was nicht gebraucht wird, oder ein Kartenpaket (PMTiles) daraus machen.",
  ],
  part_left_out: [
    "{part?feature=Objekt|placemark=Placemark} {which} ist ausgelassen: {fault?missing=Es hat keine Geometrie, die sich zeichnen lässt|type_unknown=Die Art seiner Geometrie ist nicht bekannt|nested_too_deep=Seine Geometrien sind zu tief verschachtelt|no_position=Einer Position fehlt Länge oder Breite|not_numbers=Seine Koordinaten sind keine Zahlen|swapped=Eine Position liegt nicht auf der Erde; Länge und Breite sind vielleicht vertauscht|in_metres=Eine Position liegt nicht auf der Erde; sie ist vielleicht in Metern|too_few_positions=Eine Linie braucht zwei Positionen und ein Ring drei Ecken}.",
  ],
  file_left_out: ["Die weitere Datei {file} im Archiv ist ausgelassen."],
  kind_left_out: [
    "{kind?NetworkLink=Verweise auf andere Dateien|GroundOverlay=Bilder auf dem Boden|ScreenOverlay=Bilder auf dem Schirm|PhotoOverlay=Fotos|Model=3D-Modelle|Tour=Touren|known_bearing=Bekannte Peilungen} sind ausgelassen ({count}).",
  ],
  more_left_out: ["{parts|weiterer Teil ist|weitere Teile sind} ausgelassen."],
  nothing_to_draw: ["Die Datei enthält nichts, was sich zeichnen lässt. {left_out}", "Eine andere Datei nehmen."],
  not_areas: ["{count|Punkt oder Linie ist|Punkte oder Linien sind} ausgelassen."],
  polygons_united: ["{polygons} Vielecke, die sich berühren oder überlappen, wurden zu {areas} vereinigt."],
  no_polygon: [
    "Die Datei enthält kein Vieleck.",
    "{lines?true=Eine Linie ist kein Gebiet: Sie zu einem Vieleck schließen.|false=Das Gebiet als ein oder mehrere Vielecke zeichnen und als GeoJSON (WGS84) oder KML ausgeben.}",
  ],

  area_empty: [`${WHAT} ist leer.`, "Mindestens drei Ecken zeichnen."],
  too_few_corners: [`${WHAT} hat weniger als drei verschiedene Ecken.`, "Mindestens drei zeichnen."],
  too_many_corners: [`${WHAT} hat mehr als {most} Ecken.`, "Den Umriss vereinfachen."],
  outline_unusable: [
    `${WHAT} {fault?crosses_itself=hat einen Umriss, der sich selbst kreuzt|hole_outside=hat ein Loch außerhalb des Umrisses|not_simple=ist kein einfaches Vieleck}.`,
    "Die Ecken so verschieben, dass sich keine zwei Kanten kreuzen.",
  ],
  area_too_small: ["Das Gebiet hat nur {area_m2}.", "Mindestens {least_m2} zeichnen."],
  area_too_wide: ["Das Gebiet ist {width_m} breit.", "Höchstens {most_m} auf einmal absuchen."],
  area_too_far: [
    "Das Gebiet ist {distance_m} vom Fluggerät entfernt.",
    "Das Gebiet zeichnen, wo das Fluggerät ist, oder es dorthin bringen.",
  ],
} satisfies Partial<ReasonTable>;
