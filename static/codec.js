// Which codec a clip really has, and what the browser says of its decoder.

const BOX = [0x61, 0x76, 0x63, 0x43]; // "avcC", ISO/IEC 14496-15, 5.3.3.1
const NOT_TOLD = { decoding_smooth: null, decoding_efficient: null };
const HEADER_BYTES = 65536; // the header stands at the front ("faststart")

/** Read "avc1.640020" out of an mp4's first bytes; "" where it is not H.264. */
export async function codecOf(blob) {
  const bytes = new Uint8Array(await blob.slice(0, HEADER_BYTES).arrayBuffer());
  for (let at = bytes.indexOf(BOX[0]); at >= 0; at = bytes.indexOf(BOX[0], at + 1)) {
    if (!BOX.every((byte, place) => bytes[at + place] === byte) || at + 8 > bytes.length) continue;
    // After the version: profile, compatibility, level.
    const digits = Array.from(bytes.subarray(at + 5, at + 8), (byte) =>
      byte.toString(16).padStart(2, "0"),
    );
    return `avc1.${digits.join("")}`;
  }
  return "";
}

/** Ask whether clips of this kind are decoded smoothly; null where the browser does not say. */
export async function decodingFacts({ codec, width, height, fps, bitrate }) {
  if (!codec) return NOT_TOLD;
  try {
    const contentType = `video/mp4; codecs="${codec}"`;
    const video = { contentType, width, height, bitrate, framerate: fps };
    const found = await navigator.mediaCapabilities.decodingInfo({ type: "file", video });
    return { decoding_smooth: found.smooth, decoding_efficient: found.powerEfficient };
  } catch {
    return NOT_TOLD;
  }
}
