// Reads an MCAP file twice with the reader of MCAP's makers, from its first byte to its last with every checksum, and by
// its index, and prints what it found as JSON. Node; see ../mcap_core.py.
//
//   node read.js FILE TIME_NS...    also the messages at these times, found by the index
const { open, readFile } = require("node:fs/promises");
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const schemas = require("@foxglove/schemas/jsonschema");

const text = new TextDecoder();

async function streamed(file) {
  const reader = new McapStreamReader({ validateCrcs: true });
  reader.append(await readFile(file));
  const topics = new Map();
  const counts = {};
  const metadata = {};
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Channel") topics.set(record.id, record.topic);
    if (record.type === "Metadata") metadata[record.name] = Object.fromEntries(record.metadata);
    if (record.type === "Message") {
      const topic = topics.get(record.channelId);
      counts[topic] = (counts[topic] ?? 0) + 1;
    }
  }
  return { done: reader.done(), counts, metadata };
}

async function indexed(file, times) {
  const handle = await open(file);
  const readable = {
    size: async () => BigInt((await handle.stat()).size),
    read: async (offset, length) => {
      const buffer = new Uint8Array(Number(length));
      await handle.read(buffer, 0, Number(length), Number(offset));
      return buffer;
    },
  };
  const reader = await McapIndexedReader.Initialize({ readable });
  const counts = {};
  const examples = {};
  let last = 0n;
  let ascending = true;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const { topic } = reader.channelsById.get(message.channelId);
    counts[topic] = (counts[topic] ?? 0) + 1;
    examples[topic] = JSON.parse(text.decode(message.data));
    ascending &&= message.logTime >= last;
    last = message.logTime;
  }
  const told = {};
  for (const [id, count] of reader.statistics.channelMessageCounts) {
    if (count > 0n) told[reader.channelsById.get(id).topic] = Number(count);
  }
  const at = [];
  for (const time of times) {
    const found = reader.readMessages({ topics: ["/tenon/cycle"], startTime: BigInt(time), endTime: BigInt(time) });
    for await (const message of found) at.push(JSON.parse(text.decode(message.data)));
  }
  await handle.close();
  return { counts, told, ascending, examples, at, chunks: reader.chunkIndexes.length, library: reader.header.library };
}

async function main() {
  const [file, ...times] = process.argv.slice(2);
  const found = { streamed: await streamed(file), indexed: await indexed(file, times) };
  found.schemas = { "foxglove.Log": schemas.Log, "foxglove.FrameTransform": schemas.FrameTransform };
  process.stdout.write(JSON.stringify(found));
}

main().catch((error) => {
  console.error(String(error));
  process.exit(1);
});
