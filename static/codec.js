// Which codec a clip really has, and what the browser says of its decoder.

const BOX = [0x61, 0x76, 0x63, 0x43]; // "avcC", ISO/IEC 14496-15, 5.3.3.1

/** Read "avc1.640020" out of an mp4's first bytes; "" where it is not H.264. */
export function codecOf(parts) {
  for (const part of parts) {
    for (let at = part.indexOf(BOX[0]); at >= 0; at = part.indexOf(BOX[0], at + 1)) {
      if (!BOX.every((byte, place) => part[at + place] === byte) || at + 8 > part.length) continue;
      // After the version: profile, compatibility, level.
      const digits = Array.from(part.subarray(at + 5, at + 8), (byte) =>
        byte.toString(16).padStart(2, "0"),
      );
      return `avc1.${digits.join("")}`;
    }
    if (part.length > 4096) break; // the header stands at the front ("faststart")
  }
  return "";
}

/** Ask whether clips of this kind are decoded smoothly; null where the browser does not say. */
export async function decodingFacts({ codec, width, height, fps, bitrate }) {
  try {
    const contentType = `video/mp4; codecs="${codec}"`;
    const video = { contentType, width, height, bitrate, framerate: fps };
    const found = await navigator.mediaCapabilities.decodingInfo({ type: "file", video });
    return { decoding_smooth: found.smooth, decoding_efficient: found.powerEfficient };
  } catch {
    return { decoding_smooth: null, decoding_efficient: null };
  }
}
