const MISSING = 32767;

const bytesOf = (text) => Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
const inflated = (text) =>
  new Response(new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("deflate")));

/* Lines as `overlay_view.py` writes them; those over one grid share the array of its x. A missing value is null. */
const unpacked = async ({ grids, lines, data }) => {
  const bytes = new Uint8Array(await inflated(data).arrayBuffer());
  const half = bytes.length / 2;
  let at = 0;
  const values = (count, [offset, step], missing = NaN) => {
    let sum = 0;
    const found = new Array(count);
    for (let k = 0; k < count; k += 1, at += 1) {
      sum += ((bytes[at] | (bytes[at + half] << 8)) << 16) >> 16;
      found[k] = sum === missing ? null : offset + step * sum;
    }
    return found;
  };
  const across = grids.map(({ count, scale }) => Float64Array.from(values(count, scale)));
  const curves = Object.entries(lines).map(([name, { grid, scale }]) => [name, { x: across[grid], y: values(across[grid].length, scale, MISSING) }]);
  return Object.fromEntries(curves);
};

const stopOf = async (element) => {
  const { over_time, band, panels = common.panels, ...rest } = json(element);
  return { ...rest, panels, curves: await unpacked(over_time), band: band ? await unpacked(band) : {} };
};
