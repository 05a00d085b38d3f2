export function MapsPage() { return null; }
