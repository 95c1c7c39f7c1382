// How much of something has arrived, in words.

import { text } from "./texts.js";

const MB = 1e6;

/** Write "40 % (3.1 of 7.8 MB)" as the page's language writes numbers. */
export function amountText(bytes, total) {
  const { lang } = document.documentElement;
  const one = new Intl.NumberFormat(lang, { minimumFractionDigits: 1, maximumFractionDigits: 1 });
  const percent = new Intl.NumberFormat(lang).format(Math.floor((100 * bytes) / total));
  return text("all.arrived", {
    percent,
    loaded: one.format(bytes / MB),
    total: one.format(total / MB),
  });
}
