// MapLibre's worker in the file that the page has loaded already: a second one would repeat a third of it.
import "maplibre-gl/worker";

export default import.meta.url;
