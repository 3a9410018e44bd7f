// Calls functions of the kernel in WebAssembly, as call.c does: node call.mjs KERNEL CALLS RESULTS
import { closeSync, openSync, readFileSync, writeSync } from "node:fs";

const [kernel, calls, results] = process.argv.slice(2);
const { exports } = (await WebAssembly.instantiate(readFileSync(kernel))).instance;
const content = readFileSync(calls);
const numbers = new DataView(content.buffer, content.byteOffset, content.byteLength);
const output = openSync(results, "w");
const PAGE = 65536;
const start = exports.memory.buffer.byteLength;  // behind what the module itself has there
let place = 0;

function int64() {
    place += 8;
    return numbers.getBigInt64(place - 8, true);
}

while (place < content.byteLength) {
    const name = content.toString("latin1", place, place + 64).replace(/\0+$/, "");
    place += 64;
    const counts = { blocks: Number(int64()), arguments: Number(int64()) };
    let end = start;
    const blocks = Array.from({ length: counts.blocks }, () => {
        const address = (end + 63) & -64, size = Number(int64());
        end = address + size;
        return { address, size };
    });
    const given = Array.from({ length: counts.arguments }, () => {
        const block = Number(int64()), number = int64();
        return block < 0 ? number : blocks[block].address + Number(number);
    });
    const lacking = end - exports.memory.buffer.byteLength;
    if (lacking > 0) exports.memory.grow(Math.ceil(lacking / PAGE));
    for (const { address, size } of blocks) {
        new Uint8Array(exports.memory.buffer, address, size).set(content.subarray(place, place + size));
        place += size;
    }
    writeSync(output, new BigInt64Array([exports[`${name}_v1`](...given)]));
    for (const { address, size } of blocks) {
        writeSync(output, new Uint8Array(exports.memory.buffer, address, size));
    }
}
closeSync(output);
