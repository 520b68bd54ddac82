// Drives a report page and leaves what it found in an element that the caller reads.
"use strict";
(async () => {
  const found = [];
  const check = (name, isMet, figure = "") => found.push({ name, isMet: Boolean(isMet), figure: String(figure) });
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  try {
    const lines = () => document.querySelectorAll("#plot-locus polyline").length;
    const before = lines();
    check("the root locus is drawn", before > 0, before);
    document.getElementById("none").click();
    check("branches can be hidden", lines() === 0, lines());
    document.getElementById("all").click();
    check("and shown again", lines() === before, lines());

    const plot = document.querySelector("#plot-frequency svg");
    const label = () => [...plot.querySelectorAll("text")].map((t) => t.textContent).join(" ");
    const abscissa = document.getElementById("abscissa");
    for (const [value, word] of [["eas", "equivalent"], ["pressure", "dynamic pressure"], ["tas", "true airspeed"]]) {
      abscissa.value = value;
      abscissa.dispatchEvent(new Event("change"));
      check(`the abscissa becomes ${value}`, label().includes(word));
    }

    const box = plot.getBoundingClientRect();
    const tip = document.querySelector("#plot-frequency .tip");
    let words = "";
    for (let i = 1; i < 60 && !words; i += 1) {
      plot.dispatchEvent(new PointerEvent("pointermove",
        { clientX: box.left + box.width / 2, clientY: box.top + (box.height * i) / 60, bubbles: true }));
      if (tip.style.display === "block") words = tip.textContent;
    }
    check("pointing names branch and values", /V .*m\/s[^]*g .*k /.test(words), words.replace(/\n/g, " | "));

    const canvas = document.getElementById("viewer");
    const select = document.getElementById("motion");
    check("there are motions to choose from", select.options.length > 1, select.options.length);
    const first = canvas.toDataURL();
    await wait(400);
    const later = canvas.toDataURL();
    check("the surface moves", first !== later);
    document.getElementById("play").click();
    await wait(50);
    const held = canvas.toDataURL();
    await wait(200);
    check("it stops", held === canvas.toDataURL());
    canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
    check("it turns by the keyboard", held !== canvas.toDataURL());
    const turned = canvas.toDataURL();
    const wheel = (options) => {
      const event = new WheelEvent("wheel", { deltaY: 100, cancelable: true, bubbles: true, ...options });
      canvas.dispatchEvent(event);
      return event.defaultPrevented;
    };
    canvas.blur();
    check("the wheel over the viewer scrolls the page", !wheel({}));
    check("with Ctrl it zooms", wheel({ ctrlKey: true }));
    canvas.focus({ preventScroll: true });
    check("once the viewer has focus it zooms", wheel({}));
    canvas.blur();
    select.value = "pressure";
    select.dispatchEvent(new Event("change"));
    check("the steady pressure is shown", select.value === "pressure" && turned !== canvas.toDataURL());
  } catch (error) {
    check(`the page does as it is told: ${error}`, false);
  }
  const heights = [...document.querySelectorAll(".plot svg text")].map((text) =>
    parseFloat(getComputedStyle(text).fontSize) * (text.ownerSVGElement.getBoundingClientRect().width / 1000))
    .filter((height) => height > 0);
  check("letters of the diagrams are large enough", Math.min(...heights) > 11.5, Math.min(...heights).toFixed(1));
  const width = document.documentElement.scrollWidth;
  check("nothing is wider than the window", width <= innerWidth, `${width} of ${innerWidth}`);
  const cut = [...document.querySelectorAll(".scroll")].filter((part) => part.scrollWidth > part.clientWidth);
  check("no table is cut", cut.length === 0, cut.map((part) => `${part.scrollWidth} of ${part.clientWidth}`).join(", "));
  check("no script fails", window.failures.length === 0, window.failures.join("; "));
  const outside = performance.getEntriesByType("resource").map((entry) => entry.name);
  check("nothing is fetched", outside.length === 0, outside.join(" "));
  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = btoa(unescape(encodeURIComponent(JSON.stringify(found))));
  document.body.append(outcome);
})();
