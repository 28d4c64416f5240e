// Lossless pictures of any settings: those that were on the stage are kept, others are asked for.
import { postForFile } from "./server.js";
import { isSame } from "./settings.js";

const KEPT = 24;

export class Pictures {
  #kept = []; // {settings, view, blob}, the newest last
  #shaders = 0; // how often they became others

  constructor({ connection, stage }) {
    stage.addEventListener("still", () => {
      const { blob, header, settings } = stage.picture();
      if (!header.stand_in) this.#keep({ settings, view: header.view, blob });
    });
    connection.addEventListener("message", ({ detail }) => {
      if (!detail.shaders) return;
      this.#kept = [];
      this.#shaders++;
    });
  }

  // The PNG's blob; an Error with the server's one sentence where there is none.
  async of(settings, view) {
    const found = this.#kept.find((one) => one.view === view && isSame(one.settings, settings));
    if (found) return found.blob;
    const shaders = this.#shaders;
    const blob = await postForFile("picture", { settings, view });
    if (shaders === this.#shaders) this.#keep({ settings, view, blob });
    return blob;
  }

  #keep(picture) {
    this.#kept = [...this.#kept.filter((one) => one.view !== picture.view || !isSame(one.settings, picture.settings)), picture];
    this.#kept = this.#kept.slice(-KEPT);
  }
}
