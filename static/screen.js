// What this screen can show, in device pixels.

/** Facts about the screen and window that are stored with every play. */
export function screenFacts() {
  const ratio = devicePixelRatio;
  return {
    screen_width_px: Math.round(screen.width * ratio),
    screen_height_px: Math.round(screen.height * ratio),
    viewport_width_px: Math.round(document.documentElement.clientWidth * ratio),
    viewport_height_px: Math.round(innerHeight * ratio),
    device_pixel_ratio: ratio,
    is_fullscreen: !isWindowed(),
  };
}

/** True unless the page fills the screen, by script or by the key F11. */
export function isWindowed() {
  return !document.fullscreenElement && !matchMedia("(display-mode: fullscreen)").matches;
}

/** Call `changed` when the page moves to a screen of another pixel ratio, zooms or is resized. */
export function watchScreen(changed) {
  const stop = new AbortController();
  addEventListener("resize", changed, { signal: stop.signal });
  document.addEventListener("fullscreenchange", changed, { signal: stop.signal });
  return () => stop.abort();
}

/** Fill the screen if the browser can; where it cannot (iPhone), go on without. */
export async function enterFullscreen() {
  if (document.fullscreenElement || !document.documentElement.requestFullscreen) return;
  try {
    await document.documentElement.requestFullscreen({ navigationUI: "hide" });
  } catch {
    // Refused: player.js says so if the clip does not fit without it.
  }
}
