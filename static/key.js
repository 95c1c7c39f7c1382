// Names that nobody else comes up with.

/** A random name of 32 hexadecimal digits; randomUUID is absent on plain http under a host name. */
export function newKey() {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
}
