// What scripts say to participants: texts of the catalogue that the server put into the page.

let block = null; // the element the texts were read from; a page that is swapped in brings its own
let texts = {};
let plurals = null;

/** Return a text with its places filled; a number named `count` chooses among plural forms. */
export function text(key, values = {}) {
  read();
  const found = texts[key];
  const sentence =
    typeof found === "string" ? found : (found[plurals.select(values.count)] ?? found.other);
  return sentence.replace(/\{(\w+)\}/g, (_, name) => String(values[name]));
}

function read() {
  const present = document.getElementById("texts");
  if (present === block) return;
  block = present;
  texts = JSON.parse(present.textContent);
  plurals = new Intl.PluralRules(document.documentElement.lang);
}
