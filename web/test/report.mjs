// The report of a study, in Chromium: report.mjs REPORT.html
//
// At 1,200 pixels neither the page nor a table in it scrolls sideways. Nor does the page at 1,280 and 390 pixels, where the
// first screen has the sentence, the two pictures, their ratio and the curve.
import { Suite } from "./suite.mjs";

const suite = new Suite(process.argv[2]);

suite.run(async () => {
  for (const [width, height] of [[1200, 2000], [1280, 800], [390, 844]]) {
    const tab = await suite.tab({ width, height });
    await tab.goto(suite.address);
    const found = await tab.evaluate(() => {
      const parts = [...document.querySelectorAll(".wide, .chart")];
      const box = (part) => document.querySelector(part).getBoundingClientRect();
      return {
        width: document.scrollingElement.scrollWidth,
        tooWide: parts.filter((part) => part.scrollWidth > part.clientWidth).length,
        isFirst: [".summary", ".bezel", ".ratio"].every((part) => box(part).bottom <= innerHeight) && box(".chart").top < innerHeight,
        pictures: [...document.querySelectorAll(".bezel img")].filter(({ naturalWidth }) => naturalWidth === 320).length,
        parts: parts.length,
      };
    });
    const { width: page, tooWide, isFirst, pictures, parts } = found;
    const holds = page <= width && (width !== 1200 || (parts > 0 && tooWide === 0)) && (width === 1200 || (isFirst && pictures === 2));
    suite.check(`the report at ${width} pixels`, holds, JSON.stringify(found));
    await tab.close();
  }
});
