// Pictures in PNG, looked at by a page of the browser.
export class Pictures {
  #page;

  static async open(browser) {
    const pictures = new Pictures();
    pictures.#page = await browser.page();
    return pictures;
  }

  // {width, height, differing: pixels that differ by more than `tolerance` of 255 in a channel,
  // largest: difference}; both null where the sizes are not the same.
  compare(first, second, tolerance) {
    return this.#page.evaluate(async ([one, other, most]) => {
      const read = async (base64) => {
        const bytes = Uint8Array.from(atob(base64), (char) => char.charCodeAt(0));
        const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
        const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
        const pen = canvas.getContext('2d');
        pen.drawImage(bitmap, 0, 0);
        return pen.getImageData(0, 0, bitmap.width, bitmap.height);
      };
      const [a, b] = [await read(one), await read(other)];
      const size = { width: a.width, height: a.height };
      if (a.width !== b.width || a.height !== b.height)
        return { ...size, differing: null, largest: null };
      let [differing, largest] = [0, 0];
      for (let i = 0; i < a.data.length; i += 4) {
        let difference = 0;
        for (let channel = 0; channel < 3; ++channel)
          difference = Math.max(difference, Math.abs(a.data[i + channel] - b.data[i + channel]));
        if (difference > most) ++differing;
        largest = Math.max(largest, difference);
      }
      return { ...size, differing, largest };
    }, [first.toString('base64'), second.toString('base64'), tolerance]);
  }
}
