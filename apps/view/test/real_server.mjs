// `kaustik view` itself, for tests of the page.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = join(dirname(fileURLToPath(import.meta.url)), '../../..');
export const program = process.env.KAUSTIK ?? join(root, 'build/release/kaustik');

export class RealServer {
  /// Pictures are saved into `folder`. `token` and `port` are those of one before, or chosen.
  static async start({ scene, folder, options = [], token = '', port = 0 }) {
    const server = new RealServer();
    const args = ['view', join(root, 'scenes', scene, `${scene}.xml`), '--no-browser', '--output', folder, '--threads', '2', ...options];
    if (port) args.push('--port', String(port));
    server.process = spawn(program, args, { env: { ...process.env, ...(token ? { KAUSTIK_VIEW_TOKEN: token } : {}) } });
    server.link = await server.printedLink();
    return server;
  }

  get port() {
    return Number(new URL(this.link).port);
  }

  /// As Ctrl-C does; its exit code.
  async stop() {
    if (this.process.exitCode === null) {
      this.process.kill('SIGINT');
      await once(this.process, 'exit');
    }
    return this.process.exitCode;
  }

  /// What the page shows is compared with what is asked for without it.
  async ask(address, body = null) {
    this.cookie ??= (await this.post('session', { token: new URL(this.link).hash.slice('#token='.length) })).headers.get('set-cookie').split(';')[0];
    return body ? this.post(address, body) : fetch(this.address(address), { headers: { Cookie: this.cookie } });
  }

  async get(address) {
    const answer = await this.ask(address);
    if (!answer.ok) throw new Error(`${address}: ${answer.status} ${await answer.text()}`);
    return answer.json();
  }

  address(name) {
    return new URL(name, this.link.split('#')[0]).href;
  }

  post(name, body) {
    const headers = { 'Content-Type': 'application/json', ...(this.cookie ? { Cookie: this.cookie } : {}) };
    return fetch(this.address(name), { method: 'POST', headers, body: JSON.stringify(body) });
  }

  printedLink() {
    return new Promise((found, fail) => {
      let told = '';
      const read = (text) => {
        told += text;
        const link = /http:\S+#token=\S+/.exec(told);
        if (link) found(link[0]);
      };
      this.process.stdout.setEncoding('utf8').on('data', read);
      this.process.stderr.setEncoding('utf8').on('data', (text) => (told += text));
      this.process.on('error', fail);
      this.process.on('exit', (code) => fail(new Error(`${program} ended with ${code}: ${told}`)));
    });
  }
}
