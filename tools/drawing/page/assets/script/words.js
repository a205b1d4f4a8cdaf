// Numbers and words as they are shown.

function escaped(text) {
  const references = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;" };
  return String(text).replace(/[&<>"']/g, (c) => references[c]);
}
const px = (value) => String(Math.round(value * 10) / 10);
function readable(value, unit) {
  const text = Number.isFinite(value) ? String(Number(value.toPrecision(4))) : "-";
  return unit ? text + " " + unit : text;
}
