// What stands in a form's fields, by name: one text, or of several boxes those that are ticked.

const boxesOf = (form, name) =>
  [...form.elements].filter((field) => field.name === name && field.type === "checkbox");

/** Return what a name's fields hold. */
export function valueOf(form, name) {
  const boxes = boxesOf(form, name);
  if (boxes.length) return boxes.filter((box) => box.checked).map((box) => box.value);
  return form.elements.namedItem(name)?.value ?? "";
}

/** Put a value into a name's fields; says whether that changed anything. */
export function setValue(form, name, value) {
  if (!form.elements.namedItem(name) || value === null) return false;
  if (String(valueOf(form, name)) === String(value)) return false;
  const boxes = boxesOf(form, name);
  if (boxes.length) for (const box of boxes) box.checked = [value].flat().includes(box.value);
  else if (value === "") clearField(form, name);
  else form.elements.namedItem(name).value = value; // of radio buttons the one of this value
  return String(valueOf(form, name)) === String(value);
}

/** Take the answer out of a name's fields. */
export function clearField(form, name) {
  for (const field of form.elements) {
    if (field.name !== name) continue;
    if (field.type === "radio" || field.type === "checkbox") field.checked = false;
    else field.value = "";
  }
}
