const MISSING = 32767;

/* A loop: for the script of the plots, two million bytes, `Uint8Array.from` takes a tenth of a second. */
const bytesOf = (text) => {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let k = 0; k < bytes.length; k += 1) bytes[k] = characters.charCodeAt(k);
  return bytes;
};
const inflated = (text) =>
  new Response(new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("deflate")));

/* Lines as `overlay_view.py` writes them: differences of numbers, all low bytes before all high ones. */
const unpacked = async ({ lines, data }) => {
  const bytes = new Uint8Array(await inflated(data).arrayBuffer());
  const half = bytes.length / 2;
  let at = 0;
  const numbers = (count) => {
    let sum = 0;
    return Array.from({ length: count }, () => {
      sum += ((bytes[at] | (bytes[at + half] << 8)) << 16) >> 16;
      at += 1;
      return sum;
    });
  };
  const curves = Object.entries(lines).map(([name, { count, x, y }]) => {
    const across = Float64Array.from(numbers(count), (number) => x[0] + x[1] * number);
    const up = Float64Array.from(numbers(count), (number) => (number === MISSING ? NaN : y[0] + y[1] * number));
    return [name, { x: across, y: up }];
  });
  return Object.fromEntries(curves);
};

const stopOf = async (element) => {
  const { over_time, loops, panels = common.panels, ...rest } = json(element);
  return { ...rest, panels, curves: await unpacked(over_time), loops: await unpacked(loops) };
};
