// The recorded rows, and what lies between them.

/** The row number, with its fraction, that the time t falls on. */
export function rowAt(time, t) {
  let low = 0;
  let high = time.length - 1;
  if (high <= 0 || t <= time[0]) return 0;
  if (t >= time[high]) return high;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (time[middle] <= t) low = middle;
    else high = middle;
  }
  return low + (t - time[low]) / (time[high] - time[low]);
}

/** The same of what is constant along arrows: on the way to a row, the number there. */
export function stepReader(run, coordinate) {
  const values = run.columns[coordinate];
  if (!values) throw new Error(`no recorded column "${coordinate}"`);
  return (row) => values[Math.ceil(row)] ?? values[Math.ceil(row) + 1] ?? 0;
}

/** A function of the (fractional) row: a constant, or a recorded column. Of arrows the first node has the next's. */
export function reader(run, coordinate) {
  if (typeof coordinate === "number") return () => coordinate;
  const values = run.columns[coordinate];
  if (!values) throw new Error(`no recorded column "${coordinate}"`);
  const last = values.length - 1;
  return (row) => {
    const k = Math.min(Math.floor(row), last);
    const next = Math.min(k + 1, last);
    const from = values[k] ?? values[next] ?? 0;
    const to = values[next] ?? from;
    return from + (row - k) * (to - from);
  };
}
