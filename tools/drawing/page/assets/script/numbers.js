// The numbers of a page: its columns, and how they are searched. CMake puts the files of this folder into one
// script, in the order of tools/drawing/CMakeLists.txt, inside one function.

const data = JSON.parse(document.getElementById("page-data").textContent);

// Long columns are rounded: see tools/drawing/page/rounded_column.hpp.
const columns = new Map();
function summed({ step, differences }) {
  // A step of 0.001 is no binary number, 1000 is: dividing by it gives the decimal that was meant.
  const perUnit = step < 1 ? Math.round(1 / step) : 1;
  let sum = 0;
  return Float64Array.from(differences, (difference) => {
    if (difference === null) return NaN;
    sum += difference;
    return perUnit > 1 ? sum / perUnit : sum * step;
  });
}
function column(index) {
  if (index === undefined) return null;
  if (!columns.has(index)) {
    const stored = data.columns[index];
    const values = Array.isArray(stored)
      ? Float64Array.from(stored, (value) => (value === null ? NaN : value)) : summed(stored);
    columns.set(index, values);
  }
  return columns.get(index);
}

/// Index of the first value that is not below `wanted`. values: ascending
function lowerBound(values, wanted) {
  let low = 0;
  let high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] < wanted) low = middle + 1; else high = middle;
  }
  return low;
}
/// Index of the value nearest to `wanted`, -1 where none is within `tolerance`.
function nearest(values, wanted, tolerance) {
  let i = lowerBound(values, wanted);
  if (i > 0 && (i === values.length || wanted - values[i - 1] < values[i] - wanted)) i -= 1;
  return i < values.length && Math.abs(values[i] - wanted) <= tolerance ? i : -1;
}
function ascends(values) {
  for (let i = 1; i < values.length; i += 1) if (!(values[i] >= values[i - 1])) return false;
  return true;
}
/// Half as far again as neighbours usually are apart.
function reach(times) {
  const steps = [];
  for (let i = 1; i < times.length; i += Math.ceil(times.length / 1000)) steps.push(times[i] - times[i - 1]);
  steps.sort((a, b) => a - b);
  return steps.length === 0 ? 1 : Math.max(1.5 * steps[steps.length >> 1], 0.5);
}
