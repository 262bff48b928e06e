// What was chosen, kept behind the # of the page's address, so that it can be sent to somebody.

/** The choices in the address: a Map of texts. */
export function readAddress() {
  return new Map(new URLSearchParams(location.hash.slice(1)));
}

/** Replaces the choices; entries that are null or undefined are left out. */
export function writeAddress(choices) {
  const kept = Object.entries(choices).filter(([, value]) => value !== null && value !== undefined);
  const text = new URLSearchParams(kept.map(([key, value]) => [key, String(value)])).toString();
  history.replaceState(null, "", text ? `#${text}` : location.pathname + location.search);
}
