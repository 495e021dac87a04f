// A module that Emscripten made, in Node and in browsers alike.

/** The bytes beside this file: from disk where the page's address is one, else from where the page came from. */
async function bytes(name) {
  const url = new URL(name, import.meta.url);
  if (url.protocol === 'file:' && globalThis.process?.versions?.node) {
    const {readFile} = await import('node:fs/promises');
    return readFile(url);
  }
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}

export async function instantiate(factory, wasm, options = {}) {
  return factory({wasmBinary: await bytes(wasm), ...options});
}
