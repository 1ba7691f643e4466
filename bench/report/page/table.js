// Tables to sort and filter: {columns, rows, first}; a button in each heading, with the state in
// aria-sort. On a phone a row is a card.
const element = (name, properties = {}, ...children) => {
  const e = Object.assign(document.createElement(name), properties);
  e.append(...children);
  return e;
};

// Field as in the program's files: quotation marks keep a text a text, and an apostrophe keeps a
// spreadsheet from reading a formula.
function csv_field(x) {
  if (typeof x !== "string") return plain(x).replace("Infinity", "inf");
  const number_like = /^[-+.]*(\d|inf)/i.test(x),
    text = /^[=+@'\t-]/.test(x) && !number_like ? "'" + x : x;
  return number_like || /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

function table_of(table, caption) {
  const at = Object.fromEntries(table.columns.map((name, k) => [name, k]));
  const texts = new Set(
    table.columns.filter(name =>
      table.rows.some(row => typeof row[at[name]] === "string" && row[at[name]] !== ""),
    ),
  );
  const all = element("input", {type: "checkbox"});
  const head = element("thead"),
    body = element("tbody");
  const filter = element("input", {type: "search", size: 24, placeholder: "words of a row"}),
    save = element("button", {type: "button"}, "CSV");
  const count = element("span"),
    more = element("button", {type: "button"}, "all rows");
  const at_first = 5;
  let sorted = null,
    downward = false,
    whole = false;

  const place = new Map(table.rows.map((row, k) => [row, k]));
  // Bound shown instead of the measured value.
  const shown = (row, name) => table.shown?.[name]?.[place.get(row)];
  function written(row, name) {
    const text = plain(row[at[name]]);
    if (texts.has(name) || text === "") return text;
    const x = Number(row[at[name]]),
      bound = shown(row, name);
    if (bound) return bound;
    if (!Number.isFinite(x)) return x > 0 ? "\u221e" : "\u2212\u221e";
    if (Number.isInteger(x) && Math.abs(x) < 1e9) return String(x);
    return Math.abs(x) < 1e-3 || Math.abs(x) >= 1e6
      ? x.toExponential(2)
      : String(Number(x.toPrecision(4)));
  }
  function compare(a, b) {
    const p = a[at[sorted]],
      q = b[at[sorted]],
      sign = downward ? -1 : 1;
    if (texts.has(sorted)) return sign * plain(p).localeCompare(plain(q));
    // Empty values go last.
    return Number.isNaN(p)
      ? Number.isNaN(q)
        ? 0
        : 1
      : Number.isNaN(q)
        ? -1
        : p === q
          ? 0
          : sign * (p < q ? -1 : 1);
  }
  function fill(focused) {
    const names =
      all.checked || !table.first?.length ? table.columns : table.first.filter(name => name in at);
    head.replaceChildren(
      element(
        "tr",
        {},
        ...names.map(name => {
          const direction = name === sorted ? (downward ? "descending" : "ascending") : "none";
          const button = element(
            "button",
            {type: "button"},
            name.replaceAll("_", " ") +
              {none: "", ascending: " \u2191", descending: " \u2193"}[direction],
          );
          button.onclick = () => {
            downward = name === sorted && !downward;
            sorted = name;
            fill(name);
          };
          const th = element(
            "th",
            {scope: "col", className: texts.has(name) ? "text" : ""},
            button,
          );
          th.setAttribute("aria-sort", direction);
          if (name === focused) queueMicrotask(() => button.focus());
          return th;
        }),
      ),
    );
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const found = table.rows.filter(row => {
      const text = row.map(plain).join(" ").toLowerCase();
      return words.every(word => text.includes(word));
    });
    const rows = (sorted ? found.sort(compare) : found).slice(0, whole ? Infinity : at_first);
    count.textContent =
      rows.length < found.length
        ? ` ${rows.length} of ${found.length} rows `
        : ` ${found.length} rows `;
    more.hidden = rows.length === found.length;
    body.replaceChildren(
      ...rows.map(row => {
        const status = row[at.status];
        const tr = element("tr", {
          className:
            row[at.pareto] === true
              ? "front"
              : (status === undefined || status === "ok") && !row[at.flags]
                ? ""
                : "bad",
        });
        for (const name of names) {
          const td = element(
            "td",
            {className: (texts.has(name) ? "text " : "") + name},
            written(row, name),
          );
          td.dataset.name = name.replaceAll("_", " ");
          if (td.textContent === "") td.classList.add("empty");
          if (!texts.has(name))
            td.title = (shown(row, name) ? "measured: " : "") + plain(row[at[name]]);
          tr.append(td);
        }
        return tr;
      }),
    );
  }
  all.onchange = () => fill();
  filter.oninput = () => fill();
  more.onclick = () => {
    whole = true;
    fill();
  };
  save.onclick = () => {
    const text =
      [table.columns, ...table.rows].map(row => row.map(csv_field).join(",")).join("\n") + "\n";
    const link = element("a", {
      href: URL.createObjectURL(new Blob([text], {type: "text/csv"})),
      download: caption.toLowerCase().replaceAll(/[^a-z]+/g, "-") + ".csv",
    });
    link.click();
    URL.revokeObjectURL(link.href);
  };
  fill();
  const frame = element(
    "div",
    {className: "scroll cards", tabIndex: 0},
    element("table", {}, head, body),
  );
  frame.setAttribute("role", "region");
  frame.setAttribute("aria-label", caption + ", a table");
  const hint = element("div", {className: "menus"}, element("label", {}, "filter ", filter), save);
  if (table.first?.length && table.first?.length < table.columns.length)
    hint.append(element("label", {}, all, " every column"));
  return [hint, frame, element("p", {className: "soft"}, "The headings sort.", count, more)];
}
