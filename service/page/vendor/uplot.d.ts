// Type of uPlot: enough to see that it exists.
declare const uPlot: any;
export default uPlot;
