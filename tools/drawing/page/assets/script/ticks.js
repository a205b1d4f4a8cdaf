// Ticks of an axis. The same rules as view.cpp, for what is in view.

function ticks(low, high, logarithmic, count) {
  const result = [];
  if (logarithmic) {
    const first = Math.floor(Math.log10(low));
    const last = Math.ceil(Math.log10(high));
    const every = Math.max(1, Math.floor((last - first) / 8));
    for (let power = first; power <= last; power += every) {
      for (const factor of high < 100 * low ? [1, 2, 5] : [1]) {
        const value = factor * 10 ** power;
        if (value >= low && value <= high) result.push({ value, label: String(Number(value.toPrecision(4))) });
      }
    }
    if (result.length > 2) return result;  // else the range is so narrow that even steps serve it
  }
  let even = [];
  const fewest = Math.max(count, 1);
  for (let wanted = fewest; even.length < 3 && wanted <= fewest + 6; wanted += 1) even = evenTicks(low, high, wanted);
  return even;
}
function evenTicks(low, high, count) {
  const result = [];
  const least = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(least));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((value) => value >= least) || 10 * power;
  const digits = Math.min(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), 12);
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + step * 1e-9 && result.length < 100; k += 1) {
    const value = Math.abs(k * step) < step * 1e-6 ? 0 : k * step;
    const size = Math.max(Math.abs(value), step);
    const significant = Math.min(Math.max(Math.ceil(Math.log10(size / step) - 1e-9) + 1, 1), 15);
    const label = size >= 1e6 || step < 1e-5 ? String(Number(value.toPrecision(significant))) : value.toFixed(digits);
    result.push({ value, label });
  }
  return result;
}
