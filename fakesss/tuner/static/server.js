// Questions to the server over HTTP. Addresses are relative to the page's, which holds the token.

// What `path` answers, as JSON; an Error with the server's one sentence where it refuses (`isRefusal`), or fails.
export async function get(path) {
  return answer(await fetch(path));
}

export async function post(path, body) {
  const headers = { "Content-Type": "application/json" };
  return answer(await fetch(path, { method: "POST", headers, body: JSON.stringify(body) }));
}

// The same for an answer that is a file.
export async function postForFile(path, body, signal) {
  const headers = { "Content-Type": "application/json" };
  const response = await fetch(path, { method: "POST", headers, body: JSON.stringify(body), signal });
  return response.ok ? response.blob() : answer(response);
}

export async function upload(path, file) {
  return answer(await fetch(path, { method: "POST", body: file }));
}

async function answer(response) {
  const found = await response.json().catch(() => ({}));
  if (response.ok) return found;
  const problem = new Error(found.error ?? `The tuner answered ${response.status}; see its terminal.`);
  throw Object.assign(problem, { isRefusal: response.status === 422 });
}
