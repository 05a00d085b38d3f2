// In the place of MapLibre's globe, 22 kB: a search is some kilometres wide, and its map lies flat.
function absent(): never {
  throw new Error("this page's maps are flat: there is no globe");
}

export {
  absent as createGlobeTransform,
  absent as createVerticalPerspectiveTransform,
  absent as GlobeCameraHelper,
  absent as GlobeProjection,
  absent as VerticalPerspectiveCameraHelper,
  absent as VerticalPerspectiveProjection,
};
