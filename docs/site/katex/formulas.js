// Typesets the formulas of a page: blocks of TeX in elements of the class arithmatex.
for (const block of document.querySelectorAll("div.arithmatex")) {
  const text = block.textContent.replace(/^\s*\\\[|\\\]\s*$/g, "");
  katex.render(text, block, { displayMode: true, throwOnError: false });
}
