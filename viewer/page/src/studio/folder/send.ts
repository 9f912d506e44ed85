// SPDX-License-Identifier: GPL-3.0-or-later
// Sends a file, and tells how much of it has gone. XMLHttpRequest, since fetch does not tell that.

/** The gateway's answer. Throws an AbortError if it is cancelled. */
export function sent(
  url: URL,
  file: File,
  signal: AbortSignal,
  share: (done: number) => void,
  lost: () => Error,
): Promise<Response> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    const cancel = () => request.abort();
    signal.addEventListener('abort', cancel);
    request.upload.onprogress = (e) => share(e.total > 0 ? e.loaded / e.total : 0);
    request.onload = () => resolve(new Response(request.responseText, { status: request.status }));
    request.onerror = () => reject(lost());
    request.onabort = () => reject(new DOMException('cancelled', 'AbortError'));
    request.onloadend = () => signal.removeEventListener('abort', cancel);
    request.open('PUT', url);
    request.send(file);
  });
}
